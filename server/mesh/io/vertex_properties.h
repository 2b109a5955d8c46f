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

// Returns the names of the scalar properties of the element "vertex", except positions, normals,
// colors and texture coordinates. `beginning` must contain at least the header. The result is empty
// for a file that is not PLY.
std::vector<std::string> vertex_property_names(std::span<const std::uint8_t> beginning);

// One property with the positions of its vertices, in the file's order. The function fails with
// `invalid` if the file is not a PLY, has no such property, or ends too early.
struct VertexProperty {
  std::vector<glm::dvec3> positions;
  std::vector<double> values;
};
Result<VertexProperty> read_vertex_property(std::span<const std::uint8_t> file,
                                            const std::string& property);

// Reads one number for each vertex of a PLY or OBJ, in the order of the vertices, from a CSV with
// one column. A first line that is not a number is a heading. An empty line or nan is a vertex
// without a value. The extension of `filename` determines the scan's format. Fails with `invalid`
// and the line number for a faulty line, if the counts differ, and for other formats.
Result<VertexProperty> read_vertex_csv(std::span<const std::uint8_t> scan,
                                       const std::string& filename, std::string_view csv,
                                       Progress& progress);

// Returns the values at a geometry's welded positions. A value is the mean of the file's values at
// exactly that position. With `is_key` it is the first value, because keys have no mean. It is NaN
// if the position has no value.
std::vector<double> values_at_positions(const Geometry& geometry, const VertexProperty& property,
                                        bool is_key);

// Returns the value at a point of a triangle, interpolated between its corners. With `is_key` it is
// the value of the nearest corner. Corners without a value are ignored. The result is NaN if no
// corner has a value.
double value_in_triangle(const Geometry& geometry, const std::vector<double>& of_positions,
                         std::uint32_t triangle, const glm::vec3& weights, bool is_key);

}  // namespace strata::mesh
