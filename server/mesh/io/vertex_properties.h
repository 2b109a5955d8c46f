#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"

namespace strata {
class Progress;
}

namespace strata::mesh {

struct Geometry;

// Numbers that scanning programs store with the vertices of a PLY, such as quality, confidence,
// intensity or curvature.

// Names of the scalar properties of the element "vertex" that are neither position, normal, color
// nor texture coordinate, from the beginning of the file (the header is enough). Empty for a file
// that is no PLY.
std::vector<std::string> vertex_property_names(std::span<const std::uint8_t> beginning);

// One property with the positions of its vertices, in the file's order. Refused (invalid) for a
// file that is no PLY, has no such property, or ends too early.
struct VertexProperty {
  std::vector<glm::dvec3> positions;
  std::vector<double> values;
};
Result<VertexProperty> read_vertex_property(std::span<const std::uint8_t> file,
                                            const std::string& property);

// Reads one number for each vertex of a PLY or OBJ, in its order, from a CSV of one column: a first
// line that is no number is a heading, an empty line (or nan) a vertex without a value. The ending
// of `filename` gives the scan's format. Refused (invalid) with the faulty line, where the counts
// differ, and for other formats.
Result<VertexProperty> read_vertex_csv(std::span<const std::uint8_t> scan,
                                       const std::string& filename, std::string_view csv,
                                       Progress& progress);

// The values of a geometry's welded positions: the mean of the file's values at exactly that
// position, or the first where `is_key` (keys have no mean); NaN where it has none.
std::vector<double> values_at_positions(const Geometry& geometry, const VertexProperty& property,
                                        bool is_key);

// The value at a point of a triangle: interpolated between its corners, or that of the nearest
// corner where `is_key`. Corners without a value are left out; NaN where no corner has one.
double value_in_triangle(const Geometry& geometry, const std::vector<double>& of_positions,
                         std::uint32_t triangle, const glm::vec3& weights, bool is_key);

}  // namespace strata::mesh
