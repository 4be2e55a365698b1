/// How the row of a grain is read: which numbers of two rows a contact adds and which it subtracts.
#pragma once

namespace graindrive::loop {

/// A layout says of a row of doubles, for `Row`:
///   groups   how many groups of four doubles, from the first on, pairs read
///   sign     of each of these numbers: -1 for second - first, 1 for second + first
///   axes     how many numbers, from the first on, are positions and have a nearest image
template <class Row>
struct RowLayout;

}  // namespace graindrive::loop
