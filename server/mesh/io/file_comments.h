#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "domain/scene/model.h"
#include "mesh/io/input_files.h"

namespace strata::mesh {

// Returns the comments of a mesh file. In a PLY these are the `comment` and `obj_info` lines, in an
// OBJ the `#` lines at the beginning. In a binary STL the comment is the header, in an ASCII STL
// the first line. The result has at most kMaxComments comments in UTF-8, cut to kMaxCommentLength
// bytes. glTF has no comments.
constexpr std::size_t kMaxComments = 200, kMaxCommentLength = 500;
std::vector<std::string> file_comments(const InputFiles& files);

// A unit or an up direction stated by a comment, and the comment itself.
template <class Value>
struct Stated {
  Value value;
  std::string comment;
};

// Recognizes "unit: mm", "units millimetres", "File units = meters" (Alias, SketchUp), "obj_info
// units millimeter" and "UNITS=mm" (headers of STL). The first comment with a unit is used. If it
// names an unsupported unit, such as inches, the result is empty.
std::optional<Stated<Unit>> stated_unit(std::span<const std::string> comments);

// Recognizes "up axis: Z", "Y-up" and "y_down". The result is one of kUpDirections.
std::optional<Stated<std::string>> stated_up(std::span<const std::string> comments);

}  // namespace strata::mesh
