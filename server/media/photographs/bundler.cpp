#include <algorithm>

#include "core/text/ascii.h"
#include "media/photographs/pose_reader.h"

namespace strata::photo {
namespace {

// The words of a text, with the line of each.
class Words {
 public:
  Words(std::string_view text, std::size_t first_line) : text_(text), line_(first_line) {}

  std::string_view take() {
    const std::string_view before = text_;
    const std::string_view word = take_word(text_);
    const auto skipped = before.substr(0, before.size() - text_.size());
    line_ += static_cast<std::size_t>(std::ranges::count(skipped, '\n'));
    return word;
  }
  bool take_numbers(std::span<double> numbers) {
    for (double& number : numbers) {
      const auto value = finite_number(take());
      if (!value) return false;
      number = *value;
    }
    return true;
  }
  std::size_t line() const { return line_; }  // of the last word

 private:
  std::string_view text_;
  std::size_t line_;
};

// Returns the names in the list. A line has a name, and may have "0" and a focal length after it.
Result<std::vector<std::string>> read_names(const PoseFile& file) {
  std::vector<std::string> names;
  std::string_view rest = without_byte_order_mark(text_of(file));
  for (std::size_t line = 1; !rest.empty(); ++line) {
    std::string_view name = trimmed(take_line(rest));
    if (name.empty()) continue;
    if (names.size() >= kMaxPosedPhotographs) return too_many_photographs(file);
    const auto focal = name.find_last_of(" \t");
    const auto zero = focal == std::string_view::npos ? focal : name.find_last_of(" \t", focal - 1);
    if (zero != std::string_view::npos && finite_number(name.substr(focal + 1)) &&
        trimmed(name.substr(zero, focal - zero)) == "0")
      name = trimmed(name.substr(0, zero));
    names.push_back(photograph_name(name));
    if (names.back().empty()) return wrong_pose(file, line, "the name of a photograph is missing.");
  }
  return names;
}

}  // namespace

Result<PosedPhotographs> read_bundler(const PoseFile& bundle, const PoseFile& list) {
  const auto names = STRATA_TRY(read_names(list));
  std::string_view rest = without_byte_order_mark(text_of(bundle));
  if (trimmed(take_line(rest)) != "# Bundle file v0.3")
    return wrong_pose(bundle, 1,
                      "only version 0.3 is supported. Write the file with Bundler 0.3 or "
                      "later.");
  Words words(rest, 2);
  const auto count = whole_number(words.take());
  if (!count || !whole_number(words.take()))
    return wrong_pose(bundle, words.line(),
                      "the numbers of cameras and points are expected. Write the file again.");
  if (*count > kMaxPosedPhotographs) return too_many_photographs(bundle);
  if (*count != names.size())
    return wrong_pose(list, 0,
                      "the list has " + std::to_string(names.size()) + " photographs, but " +
                          "the bundle file " + std::to_string(*count) +
                          " cameras. Add the list of the same run.");
  PosedPhotographs read;
  for (std::size_t i = 0; i < *count; ++i) {
    double lens[3], rows[9], translation[3];
    if (!words.take_numbers(lens) || !words.take_numbers(rows) || !words.take_numbers(translation))
      return wrong_pose(bundle, words.line(),
                        "a camera needs 15 numbers. The file is damaged or incomplete. Write it "
                        "again.");
    if (lens[0] == 0) {  // Bundler did not register the photograph
      ++read.without_pose;
      continue;
    }
    Calibration calibration;
    calibration.focal = glm::dvec2(lens[0]);
    calibration.lens = {LensModel::brown, {lens[1], lens[2]}, {}};
    if (const auto good = check(calibration); !good)
      return wrong_pose(bundle, words.line(), good.error().detail);
    const auto pose =
        pose_from(kFromUpwardAxes * matrix_of_rows(rows),
                  kFromUpwardAxes * glm::dvec3(translation[0], translation[1], translation[2]));
    if (!pose)
      return wrong_pose(bundle, words.line(),
                        "the matrix of camera " + std::to_string(i + 1) +
                            " is not a rotation. Write the file again.");
    read.photographs.push_back({names[i], calibration, *pose});
  }
  return read;
}

}  // namespace strata::photo
