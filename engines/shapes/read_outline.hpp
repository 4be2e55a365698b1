/// Outlines from files: one POLYGON in WKT, or a table of vertices in CSV.
#pragma once
#include <string>

#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

/// Reads an outline; the content says which format it is, not the name.
///
/// WKT: one `POLYGON ((x y, x y, ...))`, without holes, alone or as the one quoted geometry of a table (see wkt.hpp). CSV: x and
/// y of one vertex a line, separated by semicolon, comma, tab or blanks; text after `#` is a comment; the first line may be a
/// header that names x and y, with units in brackets. The text is UTF-8, of at most 4 MiB and 400,000 lines.
/// @throws std::invalid_argument naming the file, and the line or vertex, for anything else
Outline read_outline(const std::string& path);

/// The vertices written in `text`, unchecked, by the same rules.
Points vertices_in(const std::string& text);

}  // namespace graindrive::shapes
