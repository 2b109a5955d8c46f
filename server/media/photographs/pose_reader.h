#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "media/photographs/posed_photographs.h"

namespace strata::photo {

// Parts of the readers of the formats (posed_photographs.h). A line of 0 means that the file has no
// lines, or that the error does not concern one of them.

inline std::string_view text_of(const PoseFile& file) {
  return {reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()};
}

// An `invalid` error: "cameras.txt, line 3: …".
tl::unexpected<Error> wrong_pose(const PoseFile& file, std::size_t line, const std::string& detail);
// A `too_large` error for more than kMaxPosedPhotographs.
tl::unexpected<Error> too_many_photographs(const PoseFile& file);

// Takes the next word, up to a blank, from the front of `text`. Returns an empty word at the end.
std::string_view take_word(std::string_view& text);
// Takes the next line without its end, which is LF or CRLF.
std::string_view take_line(std::string_view& text);
std::string_view without_byte_order_mark(std::string_view text);

// The whole word must be a finite number. An exponent may have leading zeros, as on Windows.
std::optional<double> finite_number(std::string_view word);
std::optional<std::uint64_t> whole_number(std::string_view word);

// Reads exactly `numbers.size()` finite numbers, separated by blanks. Returns false for others.
bool read_numbers(std::string_view text, std::span<double> numbers);

// Returns a name as `PosedPhotograph::name` describes it. Empty if nothing remains.
std::string photograph_name(std::string_view stated);
// Returns the name without folders, in lower case.
std::string plain_name(std::string_view filename);

// Returns the rotation closest to the matrix, or nothing if an entry is not finite, or the matrix
// deviates from a rotation by more than 0.001 (entries of MᵀM).
std::optional<glm::dmat3> mended_rotation(const glm::dmat3& matrix);
// The matrix of nine numbers, row by row.
glm::dmat3 matrix_of_rows(std::span<const double, 9> rows);

// From a rotation and translation of world to camera axes. Returns nothing if the matrix is not a
// rotation or the center is not finite.
std::optional<Pose> pose_from(const glm::dmat3& rotation, const glm::dvec3& translation);
// From a rotation of world to camera axes, and the center of the camera.
std::optional<Pose> pose_at(const glm::dmat3& rotation, const glm::dvec3& center);

// From axes with y up and z away from the scene, as in photogrammetry and OpenGL, to those of Pose.
inline const glm::dmat3 kFromUpwardAxes{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};

// The readers. Each gets the files of its format only, at least one.
Result<PosedPhotographs> read_colmap_text(const PoseFile& cameras, const PoseFile& images);
Result<PosedPhotographs> read_colmap_binary(const PoseFile& cameras, const PoseFile& images);
Result<PosedPhotographs> read_metashape(const PoseFile& file);
Result<PosedPhotographs> read_realitycapture_csv(const PoseFile& file);
Result<PosedPhotographs> read_realitycapture_xmp(std::span<const PoseFile* const> files);
Result<PosedPhotographs> read_bundler(const PoseFile& bundle, const PoseFile& list);

}  // namespace strata::photo
