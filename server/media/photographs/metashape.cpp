#include <unordered_map>

#include "core/text/ascii.h"
#include "media/photographs/pose_xml.h"

namespace strata::photo {
namespace {

using pugi::xml_node;

// From the coordinates of a component to those of the world: scale × rotation × point +
// translation.
struct Similarity {
  glm::dmat3 rotation{1.0};
  glm::dvec3 translation{0};
  double scale = 1;
};

// A camera that cannot be used has a reason instead of a calibration.
struct Sensor {
  Calibration calibration;
  std::optional<std::string> reason;
};

class MetashapeReader {
 public:
  explicit MetashapeReader(const PoseFile& file) : file_(file) {}

  Result<PosedPhotographs> read() {
    pugi::xml_document document;
    STRATA_TRY(parse_pose_xml(document, file_));
    const xml_node root = document.child("document"), chunk = root.child("chunk");
    if (!chunk) return wrong(root, "the XML has no chunk. Use \"Export Cameras\" of Metashape.");
    if (chunk.next_sibling("chunk"))
      return wrong(chunk.next_sibling("chunk"),
                   "the XML has several chunks. Export the cameras of one chunk.");
    for (const xml_node sensor : chunk.child("sensors").children("sensor"))
      STRATA_TRY(read_sensor(sensor));
    STRATA_TRY(read_transformations(chunk));
    const xml_node cameras = chunk.child("cameras");
    // Cameras can be in groups. The loop visits all nodes without recursion, because a file can
    // nest them deeply.
    for (xml_node node = cameras.first_child(); node; node = following(node, cameras))
      if (node.type() == pugi::node_element && std::string_view(node.name()) == "camera")
        STRATA_TRY(read_camera(node));
    read_.coordinate_system = trimmed(chunk.child("reference").text().get());
    read_.is_geocentric = chunk_ && !read_.coordinate_system.empty() &&
                          !read_.coordinate_system.starts_with("LOCAL_CS");
    return std::move(read_);
  }

 private:
  static xml_node following(xml_node node, const xml_node& root) {
    if (const xml_node child = node.first_child()) return child;
    while (node != root) {
      if (const xml_node next = node.next_sibling()) return next;
      node = node.parent();
    }
    return {};
  }

  tl::unexpected<Error> wrong(const xml_node& node, const std::string& detail) const {
    return wrong_pose(file_, line_of(file_, node), detail);
  }

  static std::string text_in(const xml_node& node) { return node.text().get(); }

  Result<double> number(const xml_node& parent, const char* name, double missing) const {
    const xml_node node = parent.child(name);
    if (!node) return missing;
    double value = 0;
    if (!read_numbers(text_in(node), {&value, 1}))
      return wrong(node, std::string(name) + " is not a number. Export the cameras again.");
    return value;
  }

  Result<void> read_sensor(const xml_node& node) {
    Sensor sensor;
    xml_node calibration = node.child("calibration");
    for (const xml_node other : node.children("calibration"))
      if (std::string_view(other.attribute("class").value()) == "adjusted") calibration = other;
    const std::string type =
        calibration.attribute("type").as_string(node.attribute("type").as_string("frame"));
    if (type != "frame")
      sensor.reason =
          "Its camera has the type " + photograph_name(type) +
          ". Strata reads frame cameras only. Export undistorted photographs, and align "
          "them.";
    else if (!calibration)
      sensor.reason =
          "Its camera has no calibration. Align the photographs, and export the cameras.";
    else if (calibration.child("fx"))
      sensor.reason =
          "Its calibration is of an old PhotoScan. Export the cameras with Metashape 1.5 or later.";
    else
      sensor.calibration = STRATA_TRY(read_calibration(node, calibration));
    const auto id = whole_number(node.attribute("id").value());
    if (!id || !sensors_.emplace(*id, std::move(sensor)).second)
      return wrong(node, "a sensor has no number of its own. Export the cameras again.");
    return {};
  }

  Result<Calibration> read_calibration(const xml_node& sensor, const xml_node& node) const {
    const xml_node size =
        node.child("resolution") ? node.child("resolution") : sensor.child("resolution");
    const auto width = whole_number(size.attribute("width").value());
    const auto height = whole_number(size.attribute("height").value());
    if (!width || !height || *width == 0 || *height == 0 || *width > kMaxPhotographSide ||
        *height > kMaxPhotographSide)
      return wrong(node, "the camera has no valid resolution. Export the cameras again.");
    Calibration out;
    out.width = static_cast<int>(*width);
    out.height = static_cast<int>(*height);
    const double f = STRATA_TRY(number(node, "f", 0)), b1 = STRATA_TRY(number(node, "b1", 0));
    out.focal = {f + b1, f};
    out.skew = STRATA_TRY(number(node, "b2", 0));
    out.offset.x = STRATA_TRY(number(node, "cx", 0));
    out.offset.y = STRATA_TRY(number(node, "cy", 0));
    out.lens.model = LensModel::brown;
    constexpr const char* kRadial[] = {"k1", "k2", "k3", "k4"};
    constexpr const char* kTangential[] = {"p1", "p2", "p3", "p4"};
    for (std::size_t i = 0; i < 4; ++i) {
      out.lens.radial[i] = STRATA_TRY(number(node, kRadial[i], 0));
      out.lens.tangential[i] = STRATA_TRY(number(node, kTangential[i], 0));
    }
    if (const auto good = check(out); !good) return wrong(node, good.error().detail);
    return out;
  }

  Result<std::optional<Similarity>> read_similarity(const xml_node& parent) const {
    const xml_node node = parent.child("transform");
    if (!node.child("rotation")) return std::nullopt;
    double rows[9], translation[3];
    Similarity out;
    if (!read_numbers(text_in(node.child("rotation")), rows) ||
        !read_numbers(text_in(node.child("translation")), translation))
      return wrong(
          node,
          "the transformation needs a rotation of 9 numbers and a translation of 3. Export "
          "the cameras again.");
    out.scale = STRATA_TRY(number(node, "scale", 1));
    const auto rotation = mended_rotation(matrix_of_rows(rows));
    if (!rotation || !(out.scale > 0))
      return wrong(node,
                   "the transformation is not a rotation with a positive scale. Export the cameras "
                   "again.");
    out.rotation = *rotation;
    out.translation = {translation[0], translation[1], translation[2]};
    return out;
  }

  Result<void> read_transformations(const xml_node& chunk) {
    chunk_ = STRATA_TRY(read_similarity(chunk));
    const xml_node components = chunk.child("components");
    for (const xml_node component : components.children("component")) {
      const auto id = whole_number(component.attribute("id").value());
      if (!id) return wrong(component, "a component has no number. Export the cameras again.");
      auto similarity = STRATA_TRY(read_similarity(component));
      if (components_.empty()) active_ = *id;
      components_[*id] = similarity ? similarity : chunk_;
    }
    if (const auto id = whole_number(components.attribute("active_id").value());
        id && components_.contains(*id))
      active_ = *id;
    if (!components_.empty()) chunk_ = components_[active_];
    return {};
  }

  // Returns null for a component that has no common place with the active one.
  const std::optional<Similarity>* placed(const xml_node& camera) const {
    const auto id = whole_number(camera.attribute("component_id").value());
    if (!id || *id == active_) return &chunk_;
    const auto found = components_.find(*id);
    if (found == components_.end()) return &chunk_;
    return found->second && chunk_ ? &found->second : nullptr;
  }

  Result<void> read_camera(const xml_node& node) {
    if (++cameras_ > kMaxPosedPhotographs) return too_many_photographs(file_);
    const xml_node transform = node.child("transform");
    if (!transform || !node.attribute("enabled").as_bool(true)) {
      ++read_.without_pose;
      return {};
    }
    const std::optional<Similarity>* const place = placed(node);
    if (!place) {
      ++read_.in_other_components;
      return {};
    }
    std::string name = photograph_name(node.attribute("label").value());
    if (name.empty()) return wrong(node, "a camera has no label. Export the cameras again.");
    const auto id = whole_number(node.attribute("sensor_id").value());
    const auto sensor = id ? sensors_.find(*id) : sensors_.end();
    if (sensor == sensors_.end())
      return wrong(node,
                   "the camera refers to a sensor that is missing. Export the cameras again.");
    if (sensor->second.reason) {
      read_.refused.push_back(
          {std::move(name),
           {ErrorCode::unsupported, "Camera not supported", *sensor->second.reason, "files"}});
      return {};
    }
    const auto pose = pose_of(transform, place->value_or(Similarity{}));
    if (!pose)
      return wrong(transform,
                   "the transformation of the camera is not a rotation with a translation. Export "
                   "the cameras again.");
    read_.photographs.push_back({std::move(name), sensor->second.calibration, *pose});
    return {};
  }

  static std::optional<Pose> pose_of(const xml_node& node, const Similarity& place) {
    double m[16];  // from the camera to its component, row by row
    if (!read_numbers(text_in(node), m)) return std::nullopt;
    if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1) return std::nullopt;
    const double rows[9] = {m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]};
    const glm::dmat3 world_from_camera = place.rotation * matrix_of_rows(rows);
    const glm::dvec3 center =
        place.scale * (place.rotation * glm::dvec3(m[3], m[7], m[11])) + place.translation;
    return pose_at(glm::transpose(world_from_camera), center);
  }

  const PoseFile& file_;
  PosedPhotographs read_;
  std::unordered_map<std::uint64_t, Sensor> sensors_;
  std::unordered_map<std::uint64_t, std::optional<Similarity>> components_;
  std::optional<Similarity> chunk_;  // of the active component, or of the chunk
  std::uint64_t active_ = 0;
  std::size_t cameras_ = 0;
};

}  // namespace

Result<PosedPhotographs> read_metashape(const PoseFile& file) {
  return MetashapeReader(file).read();
}

}  // namespace strata::photo
