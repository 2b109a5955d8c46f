#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <unordered_map>

#include "core/text/ascii.h"
#include "media/photographs/pose_reader.h"

namespace strata::photo {
namespace {

constexpr std::string_view kRotationWrong =
    "the quaternion and the translation are not a camera pose. Export the model again.";

// The models of COLMAP with their number of parameters (src/colmap/sensor/models.h). The index is
// their number in binary files.
struct ColmapModel {
  std::string_view name;
  std::size_t parameters;
  bool is_supported = true;
};
constexpr ColmapModel kModels[] = {{"SIMPLE_PINHOLE", 3},
                                   {"PINHOLE", 4},
                                   {"SIMPLE_RADIAL", 4},
                                   {"RADIAL", 5},
                                   {"OPENCV", 8},
                                   {"OPENCV_FISHEYE", 8},
                                   {"FULL_OPENCV", 12},
                                   {"FOV", 5, false},
                                   {"SIMPLE_RADIAL_FISHEYE", 4},
                                   {"RADIAL_FISHEYE", 5},
                                   {"THIN_PRISM_FISHEYE", 12, false},
                                   {"RAD_TAN_THIN_PRISM_FISHEYE", 16, false},
                                   {"SIMPLE_DIVISION", 4, false},
                                   {"DIVISION", 5, false},
                                   {"SIMPLE_FISHEYE", 3},
                                   {"FISHEYE", 4},
                                   {"EUCM", 6, false}};
constexpr std::size_t kMaxParameters = 16;

struct ColmapCamera {
  const ColmapModel* model;
  Calibration calibration;  // only if the model is supported
};
using ColmapCameras = std::unordered_map<std::uint64_t, ColmapCamera>;

// Returns the calibration of a supported model. Its parameters are one focal length or two, the
// principal point, and the coefficients of the lens.
Calibration calibration_of(const ColmapModel& model, std::uint64_t width, std::uint64_t height,
                           std::span<const double> parameters) {
  Calibration out;
  // `check` refuses sizes out of range.
  const auto side = [](std::uint64_t value) {
    return static_cast<int>(std::min<std::uint64_t>(value, kMaxPhotographSide + 1));
  };
  out.width = side(width);
  out.height = side(height);
  const bool has_one_focal = model.name.starts_with("SIMPLE_") || model.name.starts_with("RADIAL");
  out.focal = {parameters[0], parameters[has_one_focal ? 0 : 1]};
  const auto rest = parameters.subspan(has_one_focal ? 1 : 2);
  out.offset = glm::dvec2(rest[0], rest[1]) - glm::dvec2(out.width, out.height) / 2.0;
  const auto k = rest.subspan(2);
  Lens& lens = out.lens;
  if (k.empty() && !model.name.ends_with("FISHEYE")) return out;
  const bool is_opencv = model.name == "OPENCV" || model.name == "FULL_OPENCV";
  lens.model = model.name.ends_with("FISHEYE") ? LensModel::fisheye
               : model.name == "FULL_OPENCV"   ? LensModel::rational
                                               : LensModel::brown;
  if (!is_opencv) {
    std::ranges::copy(k, lens.radial.begin());
    return out;
  }
  lens.radial[0] = k[0];
  lens.radial[1] = k[1];
  lens.tangential = {k[3], k[2]};
  std::ranges::copy(k.subspan(4), lens.radial.begin() + 2);
  return out;
}

// Adds a camera of a file, after a check of its values.
Result<void> add_camera(ColmapCameras& cameras, const PoseFile& file, std::size_t line,
                        std::uint64_t id, const ColmapModel& model, std::uint64_t width,
                        std::uint64_t height, std::span<const double> parameters) {
  ColmapCamera camera{&model, {}};
  if (model.is_supported) {
    camera.calibration = calibration_of(model, width, height, parameters);
    if (camera.calibration.width == 0 || camera.calibration.height == 0)
      return wrong_pose(file, line, "the camera has no size. Export the model again.");
    if (const auto good = check(camera.calibration); !good)
      return wrong_pose(file, line, good.error().detail);
  }
  if (cameras.size() >= kMaxPosedPhotographs) return too_many_photographs(file);
  if (!cameras.emplace(id, camera).second)
    return wrong_pose(file, line,
                      "camera " + std::to_string(id) + " occurs twice. Export the model again.");
  return {};
}

std::optional<Pose> pose_of(std::span<const double, 7> values) {
  const glm::dvec4 q(values[0], values[1], values[2], values[3]);  // w, x, y, z
  const double length = glm::length(q);
  if (!(length > 1e-6 && length < 1e6)) return std::nullopt;
  const double w = q[0] / length, x = q[1] / length, y = q[2] / length, z = q[3] / length;
  const double rows[9] = {
      1 - 2 * (y * y + z * z), 2 * (x * y - z * w),     2 * (x * z + y * w),
      2 * (x * y + z * w),     1 - 2 * (x * x + z * z), 2 * (y * z - x * w),
      2 * (x * z - y * w),     2 * (y * z + x * w),     1 - 2 * (x * x + y * y)};
  return pose_from(matrix_of_rows(rows), {values[4], values[5], values[6]});
}

// Adds a photograph of a file, after a check of its values.
Result<void> add_image(PosedPhotographs& read, const ColmapCameras& cameras, const PoseFile& file,
                       std::size_t line, std::span<const double, 7> values, std::uint64_t camera,
                       std::string_view stated_name) {
  if (read.photographs.size() + read.refused.size() >= kMaxPosedPhotographs)
    return too_many_photographs(file);
  const auto found = cameras.find(camera);
  if (found == cameras.end())
    return wrong_pose(file, line,
                      "the cameras have no camera " + std::to_string(camera) +
                          ". Add the two files of the same model.");
  std::string name = photograph_name(stated_name);
  if (name.empty())
    return wrong_pose(file, line, "the name of the photograph is missing. Export the model again.");
  const auto pose = pose_of(values);
  if (!pose) return wrong_pose(file, line, std::string(kRotationWrong));
  if (found->second.model->is_supported) {
    read.photographs.push_back({std::move(name), found->second.calibration, *pose});
    return {};
  }
  Error reason{ErrorCode::unsupported, "Camera model not supported",
               "COLMAP's camera model " + std::string(found->second.model->name) +
                   " is not supported. Undistort the photographs with COLMAP "
                   "(colmap image_undistorter), and add its photographs and cameras.",
               "files"};
  read.refused.push_back({std::move(name), std::move(reason)});
  return {};
}

Result<ColmapCameras> read_cameras_text(const PoseFile& file) {
  ColmapCameras cameras;
  std::string_view rest = without_byte_order_mark(text_of(file));
  for (std::size_t line = 1; !rest.empty(); ++line) {
    std::string_view words = trimmed(take_line(rest));
    if (words.empty() || words.starts_with('#')) continue;
    const auto id = whole_number(take_word(words));
    const auto model_name = take_word(words);
    const auto width = whole_number(take_word(words)), height = whole_number(take_word(words));
    const auto* const model = std::ranges::find(kModels, model_name, &ColmapModel::name);
    if (!id || !width || !height)
      return wrong_pose(file, line,
                        "a number, a model, a width, a height and parameters are expected. Export "
                        "the model as text again.");
    if (model == std::end(kModels))
      return wrong_pose(file, line,
                        "the camera model is unknown. Convert the model with a camera model that "
                        "Strata supports, for example OPENCV.");
    std::array<double, kMaxParameters> parameters{};
    if (!read_numbers(words, std::span(parameters).first(model->parameters)))
      return wrong_pose(file, line,
                        std::string(model->name) + " needs " + std::to_string(model->parameters) +
                            " numbers. Export the model as text again.");
    STRATA_TRY(add_camera(cameras, file, line, *id, *model, *width, *height,
                          std::span(parameters).first(model->parameters)));
  }
  return cameras;
}

// Reads little-endian values. A short file ends in a state that `is_short` reports.
class Binary {
 public:
  explicit Binary(std::span<const std::uint8_t> bytes) : rest_(bytes) {}

  template <class Value>
  Value take() {
    static_assert(std::endian::native == std::endian::little);
    Value value{};
    if (sizeof value > rest_.size()) {
      is_short_ = true;
      rest_ = {};
      return value;
    }
    std::memcpy(&value, rest_.data(), sizeof value);
    rest_ = rest_.subspan(sizeof value);
    return value;
  }

  bool take_finite(std::span<double> values) {
    bool good = true;
    for (double& value : values) good = std::isfinite(value = take<double>()) && good;
    return good;
  }

  // Takes a text with a zero at its end, at most `most` bytes. Returns an empty text for others.
  std::string_view take_text(std::size_t most) {
    const auto head = rest_.first(std::min(most + 1, rest_.size()));
    const auto end = std::ranges::find(head, std::uint8_t{0});
    is_short_ = is_short_ || end == head.end();
    if (is_short_) return {};
    const auto size = static_cast<std::size_t>(end - head.begin());
    rest_ = rest_.subspan(size + 1);
    return {reinterpret_cast<const char*>(head.data()), size};
  }

  void skip(std::uint64_t count, std::size_t size) {
    is_short_ = is_short_ || count > rest_.size() / size;
    rest_ = is_short_ ? std::span<const std::uint8_t>() : rest_.subspan(count * size);
  }

  bool is_short() const { return is_short_; }
  bool is_at_end() const { return !is_short_ && rest_.empty(); }

 private:
  std::span<const std::uint8_t> rest_;
  bool is_short_ = false;
};

tl::unexpected<Error> damaged(const PoseFile& file) {
  return wrong_pose(file, 0, "the file is damaged or incomplete. Export the model again.");
}

Result<ColmapCameras> read_cameras_binary(const PoseFile& file) {
  ColmapCameras cameras;
  Binary data(file.bytes);
  const auto count = data.take<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    const auto id = data.take<std::uint32_t>();
    const auto model = data.take<std::int32_t>();
    const auto width = data.take<std::uint64_t>(), height = data.take<std::uint64_t>();
    if (data.is_short()) return damaged(file);
    if (model < 0 || model >= std::ssize(kModels))
      return wrong_pose(file, 0,
                        "camera " + std::to_string(id) +
                            " has an unknown camera model. Convert the model with a camera model "
                            "that Strata supports, for example OPENCV.");
    std::array<double, kMaxParameters> parameters{};
    const auto used = std::span(parameters).first(kModels[model].parameters);
    if (!data.take_finite(used) || data.is_short()) return damaged(file);
    STRATA_TRY(add_camera(cameras, file, 0, id, kModels[model], width, height, used));
  }
  if (!data.is_at_end()) return damaged(file);
  return cameras;
}

}  // namespace

Result<PosedPhotographs> read_colmap_text(const PoseFile& cameras, const PoseFile& images) {
  const ColmapCameras known = STRATA_TRY(read_cameras_text(cameras));
  PosedPhotographs read;
  std::string_view rest = without_byte_order_mark(text_of(images));
  for (std::size_t line = 1; !rest.empty(); ++line) {
    std::string_view words = trimmed(take_line(rest));
    if (words.empty() || words.starts_with('#')) continue;
    const auto id = whole_number(take_word(words));
    std::array<double, 7> values{};
    bool good = id.has_value();
    for (double& value : values) {
      const auto number = finite_number(take_word(words));
      good = good && number;
      value = number.value_or(0);
    }
    const auto camera = whole_number(take_word(words));
    if (!good || !camera)
      return wrong_pose(images, line,
                        "a number, a quaternion, a translation, a camera and a name are expected. "
                        "Export the model as text again.");
    STRATA_TRY(add_image(read, known, images, line, values, *camera, trimmed(words)));
    take_line(rest);  // the points in the photograph, which may be none
    ++line;
  }
  return read;
}

Result<PosedPhotographs> read_colmap_binary(const PoseFile& cameras, const PoseFile& images) {
  const ColmapCameras known = STRATA_TRY(read_cameras_binary(cameras));
  PosedPhotographs read;
  Binary data(images.bytes);
  const auto count = data.take<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    data.take<std::uint32_t>();  // the number of the photograph
    std::array<double, 7> values{};
    const bool is_finite = data.take_finite(values);
    const auto camera = data.take<std::uint32_t>();
    const std::string_view name = data.take_text(4 * kMaxPhotographName);
    data.skip(data.take<std::uint64_t>(), 24);  // points: x, y, and the number of a point
    if (data.is_short()) return damaged(images);
    if (!is_finite) return wrong_pose(images, 0, std::string(kRotationWrong));
    STRATA_TRY(add_image(read, known, images, 0, values, camera, name));
  }
  if (!data.is_at_end()) return damaged(images);
  return read;
}

}  // namespace strata::photo
