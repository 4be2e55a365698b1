/// From rows to columns and back: the differences of the rows of a pack of pairs as six packs, and a pack's forces as rows in memory.
///
/// `RowDifference` and `Transposer<P>` exist three times; each file that includes this one gets those of the instructions it is compiled
/// for. All give the same numbers to the last bit.
#pragma once
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include "engines/loop/disks/row_transpose_avx512.hpp"
#elif defined(__AVX2__) && defined(__FMA__)
#include "engines/loop/disks/row_transpose_avx2.hpp"
#else
#include "engines/loop/disks/row_transpose_portable.hpp"
#endif
