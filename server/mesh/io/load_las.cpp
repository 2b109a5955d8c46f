#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string_view>

#include "mesh/io/load_formats.h"

namespace strata::mesh {
namespace {

constexpr std::uint64_t kPointsBetweenReports = 65536;
constexpr std::size_t kLeastHeader = 227;  // of LAS 1.0 to 1.2

// The bytes of a record and the place of its red, green and blue, for the point formats 0 to 10.
// −1: the format has no colors.
struct PointFormat {
  int bytes, rgb;
};
constexpr std::array<PointFormat, 11> kFormats{{{20, -1},
                                                {28, -1},
                                                {26, 20},
                                                {34, 28},
                                                {57, -1},
                                                {63, 28},
                                                {30, -1},
                                                {36, 30},
                                                {38, 30},
                                                {59, -1},
                                                {67, 30}}};
constexpr int kFirstLongFormat = 6;  // formats from LAS 1.4, with one byte more before the class
constexpr int kLowNoise = 7, kHighNoise = 18;

class LasReader {
 public:
  LasReader(std::span<const std::uint8_t> bytes, Progress& progress)
      : bytes_(bytes), progress_(progress) {}

  Result<LoadedMesh> read() {
    STRATA_TRY(read_header());
    STRATA_TRY(read_coordinate_system());
    STRATA_TRY(read_points());
    return std::move(loaded_);
  }

 private:
  template <class T>
  T at(std::uint64_t offset) const {
    T value;
    std::memcpy(&value, bytes_.data() + offset, sizeof value);
    return value;
  }

  Result<void> read_header() {
    if (bytes_.size() < kLeastHeader || std::memcmp(bytes_.data(), "LASF", 4) != 0)
      return refuse_file("The file is not a LAS file, or its header is cut off.");
    const int major = at<std::uint8_t>(24), minor = at<std::uint8_t>(25);
    if (major != 1 || minor > 4)
      return refuse_file("The file is LAS " + std::to_string(major) + "." + std::to_string(minor) +
                         ". The server reads LAS 1.0 to 1.4.");
    header_bytes_ = at<std::uint16_t>(94);
    data_ = at<std::uint32_t>(96);
    const int format = at<std::uint8_t>(104);
    if (format & 0xc0)
      return refuse_file(
          "The points are compressed (LAZ). Export them as LAS without compression or as PLY, for "
          "example with CloudCompare or las2las.");
    if (format >= static_cast<int>(kFormats.size()))
      return refuse_file("The point format " + std::to_string(format) +
                         " is unknown. LAS defines the formats 0 to 10.");
    long_format_ = format >= kFirstLongFormat;
    rgb_ = kFormats[format].rgb;
    stride_ = at<std::uint16_t>(105);
    if (stride_ < std::uint64_t(kFormats[format].bytes))
      return refuse_file("A record of " + std::to_string(stride_) +
                         " bytes is too short for the point format " + std::to_string(format) +
                         ".");
    count_ = at<std::uint32_t>(107);
    if (minor >= 4 && header_bytes_ >= 255 && bytes_.size() >= 255) count_ = at<std::uint64_t>(247);
    for (int k = 0; k < 3; ++k) {
      scale_[k] = at<double>(131 + 8 * k);
      offset_[k] = at<double>(155 + 8 * k);
      if (!(std::isfinite(scale_[k]) && scale_[k] != 0 && std::isfinite(offset_[k])))
        return refuse_file("The scale or the offset of the coordinates is not a number.");
    }
    if (header_bytes_ < kLeastHeader || data_ < header_bytes_ || data_ > bytes_.size())
      return refuse_file("The header states a wrong position of the points.");
    const std::uint64_t there = (bytes_.size() - data_) / stride_;
    if (count_ > there)
      return refuse_file("The file is cut off: it has " + std::to_string(there) + " of " +
                         std::to_string(count_) + " points.");
    if (count_ >= 0xffffffffu)
      return refuse_file("The file has more than 4 294 967 294 points. Divide it.");
    return {};
  }

  // The variable length records before the points contain the coordinate system.
  Result<void> read_coordinate_system() {
    constexpr std::uint64_t kRecordHeader = 54;
    std::uint64_t place = header_bytes_;
    const std::uint32_t records = at<std::uint32_t>(100);
    for (std::uint32_t i = 0; i < records && place + kRecordHeader <= data_; ++i) {
      const char* user = reinterpret_cast<const char*>(bytes_.data() + place + 2);
      const auto id = at<std::uint16_t>(place + 18), length = at<std::uint16_t>(place + 20);
      const std::uint64_t content = place + kRecordHeader;
      if (content + length > data_) break;
      if (std::string_view(user, strnlen(user, 16)) == "LASF_Projection") {
        if (id == 34735) read_geo_keys(content, length);
        if (id == 2112) read_wkt({reinterpret_cast<const char*>(bytes_.data() + content), length});
      }
      place = content + length;
    }
    if (degrees_ && loaded_.crs.empty())
      return refuse_file(
          "The coordinates are in degrees. Export the points in a projected coordinate system, "
          "such as UTM.");
    return {};
  }

  // GeoTIFF keys: groups of four numbers. The value of a key is the last one if the second is 0.
  void read_geo_keys(std::uint64_t content, std::uint16_t length) {
    constexpr int kModelType = 1024, kGeographic = 2, kProjected = 3072, kLinearUnit = 3076,
                  kMeters = 9001, kUserDefined = 32767;
    bool meters = true;
    std::string projected;
    for (std::uint64_t key = content + 8; key + 8 <= content + length; key += 8) {
      const int id = at<std::uint16_t>(key), place = at<std::uint16_t>(key + 2),
                value = at<std::uint16_t>(key + 6);
      if (place != 0) continue;
      if (id == kProjected && value != 0 && value != kUserDefined)
        projected = "EPSG:" + std::to_string(value);
      if (id == kModelType) degrees_ = value == kGeographic;
      if (id == kLinearUnit && value != kMeters) meters = false;
    }
    if (projected.empty()) return;
    loaded_.crs = projected;
    if (meters) loaded_.unit = Unit::m;
  }

  // The last EPSG code of the text is that of the whole system, except in compound systems, where
  // the first code at the end of a PROJCS or PROJCRS is meant.
  void read_wkt(std::string_view text) {
    const auto projected = std::min(text.find("PROJCS["), text.find("PROJCRS["));
    if (projected == std::string_view::npos) {
      degrees_ = text.find("GEOGCS[") != std::string_view::npos ||
                 text.find("GEOGCRS[") != std::string_view::npos;
      return;
    }
    std::string_view system = text.substr(projected);
    system = system.substr(0, end_of_brackets(system));
    for (const std::string_view begin : {"AUTHORITY[\"EPSG\",", "ID[\"EPSG\","}) {
      const auto last = system.rfind(begin);
      if (last == std::string_view::npos) continue;
      // A code deeper inside belongs to a part, such as the ellipsoid.
      if (depth_at(system, last) != 1) continue;
      std::string_view digits = system.substr(last + begin.size());
      if (digits.starts_with('"')) digits.remove_prefix(1);
      int code = 0;
      const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code);
      if (error == std::errc() && code > 0 && code < 10'000'000)
        loaded_.crs = "EPSG:" + std::to_string(code);
    }
    const bool feet = system.find("oot") != std::string_view::npos;  // "foot", "US survey foot"
    if (!feet) loaded_.unit = Unit::m;
  }

  static std::size_t end_of_brackets(std::string_view text) {
    int depth = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
      depth += text[i] == '[' ? 1 : text[i] == ']' ? -1 : 0;
      if (text[i] == ']' && depth == 0) return i + 1;
    }
    return text.size();
  }
  static int depth_at(std::string_view text, std::size_t place) {
    const auto before = text.substr(0, place);
    return static_cast<int>(std::ranges::count(before, '[') - std::ranges::count(before, ']'));
  }

  // Returns true if the file says that the point is no part of the surface.
  bool left_out(std::uint64_t record) const {
    const int flags = at<std::uint8_t>(record + 15);
    const int group = long_format_ ? at<std::uint8_t>(record + 16) : flags & 0x1f;
    const bool withheld = long_format_ ? flags & 0x04 : flags & 0x80;
    return withheld || group == kLowNoise || group == kHighNoise;
  }

  Result<void> read_points() {
    TriangleMesh& mesh = loaded_.mesh;
    mesh.positions.reserve(count_);
    std::vector<std::array<std::uint16_t, 3>> colors;
    if (rgb_ >= 0) colors.reserve(count_);
    std::uint16_t brightest = 0;
    for (std::uint64_t i = 0; i < count_; ++i) {
      if (i % kPointsBetweenReports == 0) {
        if (progress_.cancelled()) return cancelled_problem();
        progress_.report(kParsedShare * double(i) / double(count_), "Reading points");
      }
      const std::uint64_t record = data_ + i * stride_;
      if (left_out(record)) continue;
      glm::dvec3 position;
      for (int k = 0; k < 3; ++k)
        position[k] = at<std::int32_t>(record + 4 * k) * scale_[k] + offset_[k];
      mesh.positions.push_back(position);
      if (rgb_ < 0) continue;
      auto& color = colors.emplace_back();
      for (int k = 0; k < 3; ++k) color[k] = at<std::uint16_t>(record + rgb_ + 2 * k);
      brightest = std::max({brightest, color[0], color[1], color[2]});
    }
    if (const auto left = count_ - mesh.positions.size(); left > 0) {
      Repair& repair = loaded_.repairs.emplace_back();
      repair.what = "withheld or noise points left out";
      repair.count = left;
    }
    if (brightest == 0) return {};  // no colors were recorded
    // Some programs write 8 bits into the fields of 16 bits.
    const double scale = brightest > 255 ? 1 / 257.0 : 1;
    mesh.vertex_colors.reserve(colors.size());
    for (const auto& c : colors) {
      const auto byte = [&](int k) { return std::uint32_t(std::lround(c[k] * scale)); };
      mesh.vertex_colors.push_back(byte(0) | byte(1) << 8 | byte(2) << 16 | 0xff000000u);
    }
    return {};
  }

  std::span<const std::uint8_t> bytes_;
  Progress& progress_;
  LoadedMesh loaded_;
  std::uint64_t header_bytes_ = 0, data_ = 0, count_ = 0;
  std::uint64_t stride_ = 0;
  int rgb_ = -1;
  bool long_format_ = false, degrees_ = false;
  std::array<double, 3> scale_{}, offset_{};
};

}  // namespace

Result<LoadedMesh> parse_las(const InputFiles& files, Progress& progress) {
  return LasReader(files.scan().bytes, progress).read();
}

}  // namespace strata::mesh
