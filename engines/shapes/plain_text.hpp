/// What a file of vertices is as text: its encoding, its lines, and counts that bound the work before any is done.
#pragma once
#include <string>
#include <vector>

namespace graindrive::shapes {

/// @throws std::invalid_argument saying what the bytes are, if they are not plain or UTF-8 text
void require_text(const std::string& bytes);

/// The lines of a text, without byte-order mark and comments, whatever system ended them.
/// @throws std::invalid_argument for more lines than an outline can need
std::vector<std::string> lines_of(const std::string& text);

/// The first character that is not ASCII, as "U+2212"; "a byte 0xE9" for what is not UTF-8; "" if there is none.
std::string foreign_character(const std::string& text);

/// What a message adds where `text` holds such a character, for many of them look like digits or a minus sign; else "".
std::string note_on_foreign(const std::string& text);

/// Counting comes before reading, which takes far longer.
/// @throws std::invalid_argument if `count` of `what` is more than `most`
void require_count(std::size_t count, std::size_t most, const std::string& what,
	const std::string& way_out = "leave out what is finer than a bead can show");

}  // namespace graindrive::shapes
