/// From rows to columns and back, made from a row's layout: sums and differences of the rows of a pack of pairs as packs, and forces of a
/// pack as lines that are added to rows.
///
/// `LayoutDifference`, `LayoutTransposer` and `LineAdder` exist three times; each file that includes this one gets those of the
/// instructions it is compiled for. AVX-512 and AVX2 give the same numbers to the last bit.
#pragma once
#if defined(__AVX512F__) && defined(__AVX512DQ__) && defined(__AVX512VL__)
#include "engines/loop/spheres/layout_transpose_avx512.hpp"
#elif defined(__AVX2__) && defined(__FMA__)
#include "engines/loop/spheres/layout_transpose_avx2.hpp"
#else
#include "engines/loop/spheres/layout_transpose_portable.hpp"
#endif
