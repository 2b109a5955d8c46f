#include <algorithm>
#include <cmath>

#include "core/text/ascii.h"
#include "core/text/csv.h"
#include "core/text/filename.h"
#include "media/photographs/pose_xml.h"

namespace strata::photo {
namespace {

constexpr double kFilmSide = 36;  // millimeters of the longest side, for the focal length

// Brown's model has its coefficients in the order k1 k2 k3 k4 t1 t2.
void set_lens(Lens& lens, LensModel model, std::span<const double, 6> k) {
  lens.model = model;
  if (model == LensModel::division) lens.radial[0] = k[0];
  if (model != LensModel::brown) return;
  std::copy_n(k.begin(), 4, lens.radial.begin());
  lens.tangential = {k[4], k[5]};
}

// Returns the rotation from the world (x east, y north, z up) to the camera. Heading, pitch and
// roll turn an aircraft, in this order, about its down, right and forward axis. The camera looks
// down from it, with its x axis to the right wing. (Hornáček 2026, section 5.1; the order and the
// signs agree with an XMP file and a CSV of the same camera, which the test has.)
glm::dmat3 rotation_of(double heading, double pitch, double roll) {
  const double h = glm::radians(heading), p = glm::radians(pitch), r = glm::radians(roll);
  const glm::dmat3 about_z{
      {std::cos(h), -std::sin(h), 0}, {std::sin(h), std::cos(h), 0}, {0, 0, 1}};
  const glm::dmat3 about_x{
      {1, 0, 0}, {0, std::cos(p), std::sin(p)}, {0, -std::sin(p), std::cos(p)}};
  const glm::dmat3 about_y{
      {std::cos(r), 0, -std::sin(r)}, {0, 1, 0}, {std::sin(r), 0, std::cos(r)}};
  return kFromUpwardAxes * glm::transpose(about_z * about_x * about_y);
}

// The columns of the CSV. The program's users can leave out columns and change their order.
struct Column {
  std::string_view name, other_name;
  bool is_needed;
};
enum { x, y, z, heading, pitch, roll, f, px, py, k1, k2, k3, k4, t1, t2, columns };
constexpr Column kColumns[columns] = {
    {"x", "", true},     {"y", "", true},    {"alt", "z", true}, {"heading", "yaw", true},
    {"pitch", "", true}, {"roll", "", true}, {"f", "", true},    {"px", "", false},
    {"py", "", false},   {"k1", "", false},  {"k2", "", false},  {"k3", "", false},
    {"k4", "", false},   {"t1", "", false},  {"t2", "", false}};

class CsvReader {
 public:
  explicit CsvReader(const PoseFile& file) : file_(file) {}

  Result<PosedPhotographs> read() {
    std::string_view text = without_byte_order_mark(text_of(file_));
    if (std::string_view rest = text; to_lower(take_line(rest)).starts_with("#cameras")) {
      text = rest;
      lines_before_ = 1;
    }
    constexpr std::size_t kMaxRows = kMaxPosedPhotographs + 100;  // with empty ones
    if (static_cast<std::size_t>(std::ranges::count(text, '\n')) > kMaxRows)
      return too_many_photographs(file_);
    auto table = parse_csv(text, {.rows = kMaxRows + 1, .columns = 200});
    if (!table) {
      Error error = std::move(table.error());
      error.detail = base_filename(file_.name) + ": " + error.detail;
      error.field = "files";
      return tl::unexpected<Error>(std::move(error));
    }
    if (table->rows.empty()) return wrong_pose(file_, 1, "the row of names is missing.");
    if (table->rows.size() > kMaxPosedPhotographs + 1) return too_many_photographs(file_);
    STRATA_TRY(read_names(table->rows.front()));
    for (std::size_t row = 1; row < table->rows.size(); ++row)
      STRATA_TRY(read_row(table->rows[row]));
    return std::move(read_);
  }

 private:
  tl::unexpected<Error> wrong(const CsvRow& row, const std::string& detail) const {
    return wrong_pose(file_, static_cast<std::size_t>(row.line) + lines_before_, detail);
  }

  Result<void> read_names(const CsvRow& row) {
    width_ = row.cells.size();
    const auto find = [&](std::string_view wanted) -> std::optional<std::size_t> {
      for (std::size_t i = 0; i < width_; ++i) {
        const std::string cell = to_lower(trimmed(row.cells[i]));
        if (!wanted.empty() && trimmed(cell, "#") == wanted) return i;
      }
      return std::nullopt;
    };
    const auto name = find("name");
    if (!name) return wrong(row, "the column #name is missing.");
    name_ = *name;
    for (std::size_t i = 0; i < columns; ++i) {
      places_[i] = find(kColumns[i].name);
      if (!places_[i]) places_[i] = find(kColumns[i].other_name);
      if (!places_[i] && kColumns[i].is_needed)
        return wrong(row, "the column " + std::string(kColumns[i].name) +
                              " is missing. Export \"Internal/External camera parameters\".");
    }
    return {};
  }

  Result<void> read_row(const CsvRow& row) {
    if (row.cells.size() != width_)
      return wrong(row, "the row has " + std::to_string(row.cells.size()) +
                            " values, but the file " + std::to_string(width_) +
                            " columns. Export the cameras again.");
    double values[columns] = {};
    for (std::size_t i = 0; i < columns; ++i) {
      if (!places_[i]) continue;
      const auto value = finite_number(trimmed(row.cells[*places_[i]]));
      if (!value)
        return wrong(row, "the value of " + std::string(kColumns[i].name) +
                              " is not a number. Export the cameras again.");
      values[i] = *value;
    }
    std::string name = photograph_name(row.cells[name_]);
    if (name.empty()) return wrong(row, "the name of the photograph is missing.");
    Calibration calibration;
    calibration.unit = CalibrationUnit::longest_side;
    calibration.focal = glm::dvec2(values[f] / kFilmSide);
    calibration.offset = {values[px], values[py]};
    const auto k = std::span(values).subspan<k1, 6>();
    const auto is_zero = [](double coefficient) { return coefficient == 0; };
    const bool is_division = std::ranges::all_of(k.subspan(1), is_zero) && k[0] != 0;
    const bool is_pinhole = std::ranges::all_of(k, is_zero);
    set_lens(calibration.lens,
             is_pinhole    ? LensModel::pinhole
             : is_division ? LensModel::division
                           : LensModel::brown,
             k);
    if (const auto good = check(calibration); !good) return wrong(row, good.error().detail);
    const auto pose = pose_at(rotation_of(values[heading], values[pitch], values[roll]),
                              {values[x], values[y], values[z]});
    if (!pose) return wrong(row, "the angles are not a rotation. Export the cameras again.");
    read_.photographs.push_back({std::move(name), calibration, *pose});
    return {};
  }

  const PoseFile& file_;
  PosedPhotographs read_;
  std::size_t lines_before_ = 0, width_ = 0, name_ = 0;
  std::optional<std::size_t> places_[columns];
};

// The xcr values of an XMP file, which are attributes or elements of a description.
class XcrValues {
 public:
  static std::optional<XcrValues> of(const pugi::xml_document& document) {
    for (const auto description :
         document.child("x:xmpmeta").child("rdf:RDF").children("rdf:Description")) {
      XcrValues values(description);
      if (values.has("Rotation") || values.has("FocalLength35mm")) return values;
    }
    return std::nullopt;
  }

  bool has(const char* name) const { return !text(name).empty(); }
  std::string text(const char* name) const {
    const std::string full = std::string("xcr:") + name;
    const auto attribute = node_.attribute(full.c_str());
    return std::string(
        trimmed(attribute ? attribute.value() : node_.child(full.c_str()).text().get()));
  }
  pugi::xml_node node() const { return node_; }

 private:
  explicit XcrValues(const pugi::xml_node& node) : node_(node) {}
  pugi::xml_node node_;
};

Result<void> read_xmp(PosedPhotographs& read, const PoseFile& file) {
  pugi::xml_document document;
  STRATA_TRY(parse_pose_xml(document, file));
  const auto values = XcrValues::of(document);
  if (!values || !values->has("Rotation") || !values->has("Position")) {
    ++read.without_pose;
    return {};
  }
  const auto wrong = [&](const std::string& detail) {
    return wrong_pose(file, line_of(file, values->node()), detail);
  };
  const auto numbers = [&](const char* name, std::span<double> into) {
    return !values->has(name) || read_numbers(values->text(name), into);
  };
  std::string name = photograph_name(file.name);
  if (to_lower(name).ends_with(".xmp")) name.resize(name.size() - 4);
  if (name.empty()) return wrong("the file has no name. Name it like the photograph.");
  double rows[9], position[3], k[6] = {}, focal = 0, skew = 0, aspect = 1, u = 0, v = 0;
  if (!numbers("Rotation", rows) || !numbers("Position", position))
    return wrong("the rotation needs 9 numbers, and the position 3. Export the cameras again.");
  if (!numbers("DistortionCoeficients", k) || !numbers("FocalLength35mm", {&focal, 1}) ||
      !numbers("Skew", {&skew, 1}) || !numbers("AspectRatio", {&aspect, 1}) ||
      !numbers("PrincipalPointU", {&u, 1}) || !numbers("PrincipalPointV", {&v, 1}))
    return wrong("a value of the lens is not a number. Export the cameras again.");
  const auto pose = pose_at(matrix_of_rows(rows), {position[0], position[1], position[2]});
  if (!pose) return wrong("the rotation is not a rotation matrix. Export the cameras again.");
  const std::string model = values->text("DistortionModel");
  const auto refuse = [&](const std::string& reason) {
    read.refused.push_back(
        {name, {ErrorCode::unsupported, "Camera not supported", reason, "files"}});
  };
  Calibration calibration;
  if (model == "division" || model.starts_with("brown")) {
    constexpr std::string_view kBrown[] = {"brown3", "brown4", "brown3t2", "brown4t2"};
    if (model != "division" && std::ranges::find(kBrown, model) == std::end(kBrown)) {
      refuse("RealityCapture's distortion model is unknown. Export with Brown3 or Brown4.");
      return {};
    }
    set_lens(calibration.lens, model == "division" ? LensModel::division : LensModel::brown, k);
  } else if (!model.empty() && model != "none" && model != "perspective") {
    refuse("RealityCapture's distortion model is unknown. Export with Brown3 or Brown4.");
    return {};
  }
  if (skew != 0 || aspect != 1) {
    refuse("Its camera has pixels that are not square. Align the photographs without this.");
    return {};
  }
  calibration.unit = CalibrationUnit::longest_side;
  calibration.focal = glm::dvec2(focal / kFilmSide);
  calibration.offset = {u, v};
  if (const auto good = check(calibration); !good) return wrong(good.error().detail);
  read.photographs.push_back({std::move(name), calibration, *pose});
  return {};
}

}  // namespace

Result<PosedPhotographs> read_realitycapture_csv(const PoseFile& file) {
  return CsvReader(file).read();
}

Result<PosedPhotographs> read_realitycapture_xmp(std::span<const PoseFile* const> files) {
  PosedPhotographs read;
  if (files.size() > kMaxPosedPhotographs) return too_many_photographs(*files.front());
  for (const PoseFile* const file : files) STRATA_TRY(read_xmp(read, *file));
  return read;
}

}  // namespace strata::photo
