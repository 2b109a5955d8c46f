#include "media/photographs/pose_reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "core/text/ascii.h"
#include "core/text/filename.h"

namespace strata::photo {
namespace {

constexpr std::string_view kBlanks = " \t\r\n\v\f";

bool is_finite(const glm::dvec3& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

}  // namespace

tl::unexpected<Error> wrong_pose(const PoseFile& file, std::size_t line,
                                 const std::string& detail) {
  std::string place = base_filename(file.name);
  if (line > 0) place += ", line " + std::to_string(line);
  return fail(ErrorCode::invalid, "Camera poses not readable", place + ": " + detail, "files");
}

tl::unexpected<Error> too_many_photographs(const PoseFile& file) {
  return fail(ErrorCode::too_large, "Too many photographs",
              base_filename(file.name) + " has more than " + std::to_string(kMaxPosedPhotographs) +
                  " photographs. Export the cameras in several parts.",
              "files");
}

std::string_view take_word(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kBlanks), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(kBlanks));
  text.remove_prefix(word.size());
  return word;
}

std::string_view take_line(std::string_view& text) {
  const auto end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

std::optional<double> finite_number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  double value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (stop != end || word.empty() || error == std::errc::invalid_argument) return std::nullopt;
  // strtod returns the nearest zero or infinity for a number out of the range of a double.
  if (error == std::errc::result_out_of_range)
    value = std::strtod(std::string(word).c_str(), nullptr);
  if (!std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<std::uint64_t> whole_number(std::string_view word) {
  std::uint64_t value = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (stop != end || word.empty() || error != std::errc{}) return std::nullopt;
  return value;
}

bool read_numbers(std::string_view text, std::span<double> numbers) {
  for (double& number : numbers) {
    const auto value = finite_number(take_word(text));
    if (!value) return false;
    number = *value;
  }
  return take_word(text).empty();
}

std::string photograph_name(std::string_view stated) {
  // The last parts identify the photograph best if the name is too long.
  std::string out;
  while (!stated.empty()) {
    const auto slash = stated.find_last_of("/\\");
    const std::string part = base_filename(stated);
    stated = slash == std::string_view::npos ? std::string_view() : stated.substr(0, slash);
    if (part.empty()) continue;
    if (out.size() + part.size() + 1 > kMaxPhotographName) break;
    out = out.empty() ? part : part + "/" + out;
  }
  return out;
}

std::string plain_name(std::string_view filename) { return to_lower(base_filename(filename)); }

glm::dmat3 matrix_of_rows(std::span<const double, 9> rows) {
  return glm::transpose(
      glm::dmat3(rows[0], rows[1], rows[2], rows[3], rows[4], rows[5], rows[6], rows[7], rows[8]));
}

std::optional<glm::dmat3> mended_rotation(const glm::dmat3& matrix) {
  constexpr double kTolerance = 1e-3;
  const glm::dmat3 product = glm::transpose(matrix) * matrix;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      if (!(std::abs(product[column][row] - (column == row ? 1 : 0)) <= kTolerance))
        return std::nullopt;
  if (!(glm::determinant(matrix) > 0)) return std::nullopt;
  // Newton's method for the polar decomposition. Each step squares the deviation (Higham 1986).
  glm::dmat3 rotation = matrix;
  for (int step = 0; step < 4; ++step)
    rotation = (rotation + glm::transpose(glm::inverse(rotation))) * 0.5;
  return rotation;
}

std::optional<Pose> pose_at(const glm::dmat3& rotation, const glm::dvec3& center) {
  const auto mended = mended_rotation(rotation);
  if (!mended || !is_finite(center)) return std::nullopt;
  return Pose{*mended, center};
}

std::optional<Pose> pose_from(const glm::dmat3& rotation, const glm::dvec3& translation) {
  const auto mended = mended_rotation(rotation);
  if (!mended) return std::nullopt;
  const glm::dvec3 center = -(glm::transpose(*mended) * translation);
  if (!is_finite(center)) return std::nullopt;
  return Pose{*mended, center};
}

}  // namespace strata::photo
