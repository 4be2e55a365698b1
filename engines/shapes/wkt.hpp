/// Outlines in well-known text (OGC 06-103r4): one POLYGON without holes, as geographic programs and databases write it.
#pragma once
#include <string>

#include "engines/shapes/outline.hpp"

namespace graindrive::shapes {

/// True if the text opens with the name of a geometry, after an `SRID=...;` that a database may write before it.
bool is_wkt(const std::string& text);

/// The vertices of the one polygon in `text`, unchecked but for the count of numbers: two for each vertex, as many as
/// the tag says in a POLYGON Z, M or ZM, whose measures and equal heights are left out. A MULTIPOLYGON may hold one polygon.
/// @throws std::invalid_argument naming the vertex, or what stands in place of the polygon
Points vertices_in_wkt(const std::string& text);

}  // namespace graindrive::shapes
