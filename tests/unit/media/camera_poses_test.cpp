#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <glm/gtc/quaternion.hpp>

#include "media/photographs/posed_photographs.h"
#include "support/pose_files.h"

namespace strata::photo {
namespace {

using test::NamedText;
using test::read_pose_texts;
using testing::ElementsAre;
using testing::HasSubstr;

// A scene with known cameras and points. Each test writes the cameras in one format, and calculates
// the pixels of the points with the formulas of that program. Both use nothing of the reader.
struct View {
  std::string name;
  glm::dvec3 eye;
  glm::dvec3 right, down, into;  // the axes of the camera in the world
};

View view_of(const std::string& name, const glm::dvec3& eye, const glm::dvec3& target) {
  const glm::dvec3 into = glm::normalize(target - eye);
  const glm::dvec3 tilted_up = glm::normalize(glm::dvec3(0.1, -0.2, 1));
  const glm::dvec3 right = glm::normalize(glm::cross(into, tilted_up));
  return {name, eye, right, glm::cross(into, right), into};
}

const std::vector<View> kViews{view_of("north wall/a.jpg", {4, -9, 1.5}, {0, 0, 1}),
                               view_of("north wall/b.jpg", {-7, -3, 2.5}, {0.5, 0, 1}),
                               view_of("c.jpg", {1, 8, 0.5}, {0, 0.3, 1.2})};
const std::vector<glm::dvec3> kPoints{{0, 0, 0},      {1, 0.5, 2},    {-1, -0.4, 1.7},
                                      {0.3, 1.1, -1}, {-0.8, 1.5, 3}, {1.9, -1.2, 0.1}};
constexpr int kWidth = 4000, kHeight = 3000;

// The point in the axes of the camera: right, down, into the scene.
glm::dvec3 local(const View& view, const glm::dvec3& point) {
  const glm::dvec3 from_eye = point - view.eye;
  return {glm::dot(view.right, from_eye), glm::dot(view.down, from_eye),
          glm::dot(view.into, from_eye)};
}

std::string text(double value) {
  char out[40];
  std::snprintf(out, sizeof out, "%.17g", value);
  return out;
}
std::string text(std::initializer_list<double> values, const char* separator = " ") {
  std::string out;
  for (const double value : values) out += (out.empty() ? "" : separator) + text(value);
  return out;
}
std::string text(const glm::dvec3& v) { return text({v.x, v.y, v.z}); }

using Pixel = std::function<glm::dvec2(const View&, const glm::dvec3&)>;

// Compares the pixels of all points in all photographs with those of the formula.
void expect_pixels(const Result<PosedPhotographs>& found, const Pixel& pixel,
                   const std::vector<View>& views = kViews) {
  ASSERT_TRUE(found) << found.error().detail;
  ASSERT_EQ(found->photographs.size(), views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    const PosedPhotograph& photograph = found->photographs[i];
    EXPECT_EQ(photograph.name, views[i].name);
    EXPECT_LT(glm::length(photograph.pose.center - views[i].eye), 1e-9);
    const auto camera = camera_for(photograph.calibration, kWidth, kHeight);
    ASSERT_TRUE(camera) << camera.error().detail;
    for (const glm::dvec3& point : kPoints) {
      const auto shown = project(*camera, photograph.pose, point);
      ASSERT_TRUE(shown);
      EXPECT_LE(glm::length(*shown - pixel(views[i], point)), 1e-6);
    }
  }
}

TEST(CameraPoses, a_byte_order_mark_is_skipped) {
  const std::string mark = "\xef\xbb\xbf";
  const auto csv = read_pose_texts(
      {{"a.csv", mark + "#name,x,y,alt,heading,pitch,roll,f\na.jpg,1,2,3,4,5,6,7\n"}});
  EXPECT_TRUE(csv) << csv.error().detail;
  const auto xml = read_pose_texts(
      {{"a.xmp", mark + "<x:xmpmeta><rdf:RDF><rdf:Description xcr:FocalLength35mm=\"18\" "
                        "xcr:Rotation=\"1 0 0 0 1 0 0 0 1\" xcr:Position=\"1 2 3\"/></rdf:RDF>"
                        "</x:xmpmeta>"}});
  EXPECT_TRUE(xml) << xml.error().detail;
  const auto text = read_pose_texts({{"a.txt", mark + "1 PINHOLE 40 30 35 35 20 15\n"},
                                     {"b.txt", mark + "1 1 0 0 0 0 0 5 1 a.jpg\n\n"}});
  EXPECT_TRUE(text) << text.error().detail;
}

// ---- COLMAP

struct ColmapModel {
  std::string name;
  int number;
  std::vector<double> parameters;
  Pixel pixel;
};

glm::dvec2 flat(const View& view, const glm::dvec3& point) {
  const glm::dvec3 at = local(view, point);
  return {at.x / at.z, at.y / at.z};
}

// The formulas of src/colmap/sensor/models.h and of OpenCV's documentation.
std::vector<ColmapModel> colmap_models() {
  const auto radial = [](double k1, double k2) {
    return [k1, k2](const View& view, const glm::dvec3& point) {
      const glm::dvec2 p = flat(view, point);
      const double r2 = p.x * p.x + p.y * p.y;
      return p * (1 + k1 * r2 + k2 * r2 * r2) * 3500.0 + glm::dvec2(2010, 1480);
    };
  };
  const auto opencv = [](double k1, double k2, double p1, double p2, double k3 = 0, double k4 = 0,
                         double k5 = 0, double k6 = 0) {
    return [=](const View& view, const glm::dvec3& point) {
      const auto [x, y] = std::pair(flat(view, point).x, flat(view, point).y);
      const double r2 = x * x + y * y, r4 = r2 * r2, r6 = r4 * r2;
      const double factor = (1 + k1 * r2 + k2 * r4 + k3 * r6) / (1 + k4 * r2 + k5 * r4 + k6 * r6);
      const double u = x * factor + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
      const double v = y * factor + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
      return glm::dvec2(3500 * u + 2010, 3510 * v + 1480);
    };
  };
  const auto fisheye = [](double fy, double k1, double k2, double k3 = 0, double k4 = 0) {
    return [=](const View& view, const glm::dvec3& point) {
      const glm::dvec2 p = flat(view, point);
      const double r = glm::length(p), t = std::atan(r);
      const double bent =
          t + k1 * std::pow(t, 3) + k2 * std::pow(t, 5) + k3 * std::pow(t, 7) + k4 * std::pow(t, 9);
      return p / r * bent * glm::dvec2(3500, fy) + glm::dvec2(2010, 1480);
    };
  };
  return {
      {"SIMPLE_PINHOLE", 0, {3500, 2010, 1480}, radial(0, 0)},
      {"PINHOLE", 1, {3500, 3510, 2010, 1480}, opencv(0, 0, 0, 0)},
      {"SIMPLE_RADIAL", 2, {3500, 2010, 1480, -0.05}, radial(-0.05, 0)},
      {"RADIAL", 3, {3500, 2010, 1480, -0.05, 0.02}, radial(-0.05, 0.02)},
      {"OPENCV",
       4,
       {3500, 3510, 2010, 1480, -0.05, 0.02, 0.003, -0.002},
       opencv(-0.05, 0.02, 0.003, -0.002)},
      {"OPENCV_FISHEYE",
       5,
       {3500, 3510, 2010, 1480, -0.05, 0.02, 0.01, -0.004},
       fisheye(3510, -0.05, 0.02, 0.01, -0.004)},
      {"FULL_OPENCV",
       6,
       {3500, 3510, 2010, 1480, -0.05, 0.02, 0.003, -0.002, 0.01, 0.04, -0.03, 0.02},
       opencv(-0.05, 0.02, 0.003, -0.002, 0.01, 0.04, -0.03, 0.02)},
      {"SIMPLE_RADIAL_FISHEYE", 8, {3500, 2010, 1480, -0.05}, fisheye(3500, -0.05, 0)},
      {"RADIAL_FISHEYE", 9, {3500, 2010, 1480, -0.05, 0.02}, fisheye(3500, -0.05, 0.02)},
      {"SIMPLE_FISHEYE", 14, {3500, 2010, 1480}, fisheye(3500, 0, 0)},
      {"FISHEYE", 15, {3500, 3510, 2010, 1480}, fisheye(3510, 0, 0)},
  };
}

struct ColmapPose {
  glm::dquat rotation;
  glm::dvec3 translation;
};
ColmapPose colmap_pose(const View& view) {
  const glm::dmat3 world_from_camera(view.right, view.down, view.into);
  const glm::dmat3 rotation = glm::transpose(world_from_camera);
  return {glm::quat_cast(rotation), -(rotation * view.eye)};
}

std::vector<NamedText> colmap_text(const ColmapModel& model) {
  std::string cameras =
      "# Camera list with one line of data per camera:\n"
      "#   CAMERA_ID, MODEL, WIDTH, HEIGHT, PARAMS[]\n# Number of cameras: 1\n7 " +
      model.name + " 4000 3000";
  for (const double parameter : model.parameters) cameras += " " + text(parameter);
  std::string images = "# Image list with two lines of data per image:\n";
  int number = 3;
  for (const View& view : kViews) {
    const auto [q, t] = colmap_pose(view);
    images += std::to_string(number) + " " + text({q.w, q.x, q.y, q.z}) + " " + text(t) + " 7 " +
              view.name + "\n";
    // A photograph without points has an empty line.
    images += number == 4 ? "\n" : "2362.39 248.498 58396 1784.7 268.254 -1\n";
    ++number;
  }
  return {{"sparse/0/cameras.txt", cameras + "\n"}, {"sparse/0/images.txt", images}};
}

template <class Value>
void append(std::string& out, Value value) {
  char bytes[sizeof value];
  std::memcpy(bytes, &value, sizeof value);
  out.append(bytes, sizeof value);
}

std::vector<NamedText> colmap_binary(const ColmapModel& model) {
  std::string cameras, images;
  append<std::uint64_t>(cameras, 1);
  append<std::uint32_t>(cameras, 7);
  append<std::int32_t>(cameras, model.number);
  append<std::uint64_t>(cameras, kWidth);
  append<std::uint64_t>(cameras, kHeight);
  for (const double parameter : model.parameters) append(cameras, parameter);
  append<std::uint64_t>(images, kViews.size());
  std::uint32_t number = 3;
  for (const View& view : kViews) {
    const auto [q, t] = colmap_pose(view);
    append(images, number);
    for (const double value : {q.w, q.x, q.y, q.z, t.x, t.y, t.z}) append(images, value);
    append<std::uint32_t>(images, 7);
    images += view.name;
    images += '\0';
    append<std::uint64_t>(images, number - 3);
    for (std::uint32_t point = 3; point < number; ++point) {
      append(images, 12.5);
      append(images, 99.0);
      append<std::uint64_t>(images, point);
    }
    ++number;
  }
  return {{"cameras.bin", cameras}, {"images.bin", images}};
}

TEST(ColmapPoses, the_pixels_of_all_models_are_those_of_the_documentation) {
  for (const ColmapModel& model : colmap_models()) {
    SCOPED_TRACE(model.name);
    const auto as_text = read_pose_texts(colmap_text(model)),
               as_binary = read_pose_texts(colmap_binary(model));
    expect_pixels(as_text, model.pixel);
    expect_pixels(as_binary, model.pixel);
    EXPECT_EQ(as_text->format, PoseFormat::colmap);
    EXPECT_EQ(as_text->photographs[0].calibration, as_binary->photographs[0].calibration);
  }
}

TEST(ColmapPoses, the_other_files_of_a_model_are_not_needed) {
  auto files = colmap_text(colmap_models()[4]);
  for (auto& [name, content] : files)  // files of other programs have no comments
    while (content.starts_with('#')) content.erase(0, content.find('\n') + 1);
  files.push_back(
      {"points3D.txt",
       "# 3D point list\n63390 1.67241 0.292931 0.609726 115 121 122 1.3 16 6542 15 7\n"});
  files.push_back(
      {"rigs.txt", "1 2 CAMERA 1 CAMERA 2 1 -0.9 -0.001 -0.007 0.001 -0.1 0.0 0.007\n"});
  files.push_back(
      {"frames.txt", "1 1 0.998 0.04 0.04 -0.02 -5.2 -0.17 0 2 CAMERA 1 1 CAMERA 2 2\n"});
  files.push_back({"points3D.bin", std::string(8, '\0')});
  const auto found = read_pose_texts(files);
  expect_pixels(found, colmap_models()[4].pixel);
  EXPECT_THAT(found->unused_files,
              ElementsAre("points3D.txt", "rigs.txt", "frames.txt", "points3D.bin"));
}

TEST(ColmapPoses, photographs_of_other_models_are_named) {
  auto files = colmap_text(colmap_models()[4]);
  files[0].content += "8 FOV 4000 3000 3500 3500 2000 1500 0.9\n";
  files[1].content += "9 1 0 0 0 1 2 3 8 wide.jpg\n\n";
  const auto found = read_pose_texts(files);
  expect_pixels(found, colmap_models()[4].pixel);
  ASSERT_EQ(found->refused.size(), 1u);
  EXPECT_EQ(found->refused[0].name, "wide.jpg");
  EXPECT_EQ(found->refused[0].reason.code, ErrorCode::unsupported);
  EXPECT_THAT(found->refused[0].reason.detail, HasSubstr("FOV"));
}

// ---- Metashape

constexpr double kF = 3500, kCx = 11.67, kCy = -27.75, kB1 = 0.52, kB2 = -0.31;

// The frame camera of the appendix of the user manual.
glm::dvec2 metashape_pixel(const View& view, const glm::dvec3& point) {
  constexpr double k1 = -0.09, k2 = -0.07, k3 = 0.11, k4 = -0.07, p1 = -0.003, p2 = 0.001;
  const glm::dvec3 at = local(view, point);
  const double x = at.x / at.z, y = at.y / at.z, r = std::sqrt(x * x + y * y);
  const double radial =
      1 + k1 * std::pow(r, 2) + k2 * std::pow(r, 4) + k3 * std::pow(r, 6) + k4 * std::pow(r, 8);
  const double u = x * radial + (p1 * (r * r + 2 * x * x) + 2 * p2 * x * y);
  const double v = y * radial + (p2 * (r * r + 2 * y * y) + 2 * p1 * x * y);
  return {kWidth * 0.5 + kCx + u * kF + u * kB1 + v * kB2, kHeight * 0.5 + kCy + v * kF};
}

// The world of the test is where the component's transformation leads: scale 2.5, a turn about x
// and a translation.
const glm::dmat3 kTurn{{1, 0, 0}, {0, 0.6, 0.8}, {0, -0.8, 0.6}};
const glm::dvec3 kMove{100, -20, 3};
constexpr double kScale = 2.5;

std::string rows(const glm::dmat3& m) {
  return text({m[0][0], m[1][0], m[2][0], m[0][1], m[1][1], m[2][1], m[0][2], m[1][2], m[2][2]});
}

std::string metashape_camera(const View& view, int number, const std::string& attributes = "") {
  const glm::dvec3 center = glm::transpose(kTurn) * (view.eye - kMove) / kScale;
  const glm::dmat3 axes = glm::transpose(kTurn) * glm::dmat3(view.right, view.down, view.into);
  std::string matrix;
  for (int row = 0; row < 3; ++row)
    matrix += text({axes[0][row], axes[1][row], axes[2][row], center[row]}) + " ";
  return "<camera id=\"" + std::to_string(number) +
         "\" sensor_id=\"0\" component_id=\"1\" label=\"" + view.name + "\" " + attributes +
         "><transform>" + matrix + "0 0 0 1</transform><orientation>1</orientation></camera>\n";
}

constexpr std::string_view kSensors = R"xml(<?xml version="1.0" encoding="UTF-8"?>
<document version="2.0.0">
  <chunk label="Chunk 1" enabled="true">
    <sensors next_id="2">
      <sensor id="0" label="M3M (12.29mm)" type="frame">
        <resolution width="4000" height="3000"/>
        <property name="layer_index" value="0"/>
        <calibration type="frame" class="initial">
          <resolution width="4000" height="3000"/>
          <f>9999</f>
        </calibration>
        <calibration type="frame" class="adjusted">
          <resolution width="4000" height="3000"/>
          <f>3500</f><cx>11.67</cx><cy>-27.75</cy><b1>0.52</b1><b2>-0.31</b2>
          <k1>-0.09</k1><k2>-0.07</k2><k3>0.11</k3><k4>-0.07</k4><p1>-0.003</p1><p2>0.001</p2>
        </calibration>
      </sensor>
      <sensor id="1" label="Round" type="fisheye">
        <resolution width="4000" height="3000"/>
        <calibration type="fisheye" class="adjusted"><f>1200</f></calibration>
      </sensor>
    </sensors>
)xml";

std::string transformation() {
  return "<transform><rotation locked=\"true\">" + rows(kTurn) + "</rotation><translation>" +
         text(kMove) + "</translation><scale>" + text(kScale) + "</scale></transform>";
}

std::string metashape(const std::string& components, const std::string& cameras,
                      const std::string& reference = "") {
  return std::string(kSensors) + components + "<cameras next_id=\"9\" next_group_id=\"1\">" +
         cameras + "</cameras>" + reference + "</chunk></document>\n";
}

std::string components() {
  return R"(<components next_id="3" active_id="1"><component id="0" label="Component 1"/>)"
         R"(<component id="1" label="Component 2">)" +
         transformation() + "</component></components>";
}

std::string all_cameras() {
  return "<group id=\"0\" label=\"Group 1\" type=\"folder\">" + metashape_camera(kViews[0], 0) +
         metashape_camera(kViews[1], 1, "enabled=\"true\"") + "</group>" +
         metashape_camera(kViews[2], 2);
}

TEST(MetashapePoses, the_pixels_are_those_of_the_manual) {
  const auto found = read_pose_texts({{"cameras.xml", metashape(components(), all_cameras())}});
  expect_pixels(found, metashape_pixel);
  EXPECT_EQ(found->format, PoseFormat::metashape);
  EXPECT_FALSE(found->is_geocentric);
}

TEST(MetashapePoses, the_transformation_can_belong_to_the_chunk) {
  for (const std::string& around :
       {transformation(),
        "<components active_id=\"1\"><component id=\"1\"/></components>" + transformation()})
    expect_pixels(read_pose_texts({{"doc.xml", metashape(around, all_cameras())}}),
                  metashape_pixel);
}

TEST(MetashapePoses, cameras_without_a_pose_here_are_counted) {
  std::string cameras = all_cameras();
  cameras += metashape_camera(kViews[0], 3, "enabled=\"false\"");
  cameras += "<camera id=\"4\" sensor_id=\"0\" label=\"not aligned\"/>";
  std::string other = metashape_camera(kViews[0], 5);
  other.replace(other.find("component_id=\"1\""), 16, "component_id=\"0\"");
  const auto found = read_pose_texts({{"cameras.xml", metashape(components(), cameras + other)}});
  expect_pixels(found, metashape_pixel);
  EXPECT_EQ(found->without_pose, 2u);
  EXPECT_EQ(found->in_other_components, 1u);
}

TEST(MetashapePoses, fisheye_cameras_are_named) {
  std::string fisheye = metashape_camera(kViews[0], 3);
  fisheye.replace(fisheye.find("sensor_id=\"0\""), 13, "sensor_id=\"1\"");
  const auto found =
      read_pose_texts({{"cameras.xml", metashape(components(), all_cameras() + fisheye)}});
  expect_pixels(found, metashape_pixel);
  ASSERT_EQ(found->refused.size(), 1u);
  EXPECT_EQ(found->refused[0].name, kViews[0].name);
  EXPECT_THAT(found->refused[0].reason.detail, HasSubstr("fisheye"));
  const auto alone = read_pose_texts({{"cameras.xml", metashape(components(), fisheye)}});
  ASSERT_FALSE(alone);
  EXPECT_EQ(alone.error().code, ErrorCode::invalid);
  EXPECT_THAT(alone.error().detail, HasSubstr("fisheye"));
}

TEST(MetashapePoses, a_geographic_system_means_geocentric_coordinates) {
  const auto with = [](const std::string& reference) {
    return read_pose_texts(
        {{"cameras.xml",
          metashape(components(), all_cameras(), "<reference>" + reference + "</reference>")}});
  };
  const auto geographic = with("GEOGCS[&quot;WGS 84&quot;]"), in_meters = with("LOCAL_CS[]");
  ASSERT_TRUE(geographic && in_meters);
  EXPECT_TRUE(geographic->is_geocentric);
  EXPECT_EQ(geographic->coordinate_system, "GEOGCS[\"WGS 84\"]");
  EXPECT_FALSE(in_meters->is_geocentric);
}

// ---- RealityCapture

constexpr double kFilm = 31.5, kPx = 0.0072, kPy = -0.014;  // the focal length in 36 mm

glm::dvec2 realitycapture_pixel(const glm::dvec2& bent) {
  const double scale = kWidth;  // the longest side
  return glm::dvec2(kFilm / 36 * bent.x + kPx, kFilm / 36 * bent.y + kPy) * scale +
         glm::dvec2(kWidth, kHeight) / 2.0;
}

// Brown's model with the order of RealityScan: t1 is OpenCV's p2.
glm::dvec2 realitycapture_brown(const View& view, const glm::dvec3& point) {
  constexpr double k1 = -0.23, k2 = 0.07, k3 = -0.01, k4 = 0.002, t1 = 0.003, t2 = -0.001;
  const double x = flat(view, point).x, y = flat(view, point).y, r2 = x * x + y * y;
  const double radial =
      k1 * r2 + k2 * std::pow(r2, 2) + k3 * std::pow(r2, 3) + k4 * std::pow(r2, 4);
  return realitycapture_pixel({x + x * radial + t2 * (2 * x * y) + t1 * (r2 + 2 * x * x),
                               y + y * radial + t1 * (2 * x * y) + t2 * (r2 + 2 * y * y)});
}

glm::dvec2 realitycapture_division(const View& view, const glm::dvec3& point) {
  const glm::dvec2 p = flat(view, point);
  return realitycapture_pixel(p / (1 + 0.2 * glm::dot(p, p)));
}

// The angles of an aircraft with the camera below it, in degrees: the nose points to the top of the
// photograph, and the right wing to the right.
std::string csv_line(const View& view, const std::string& lens) {
  const glm::dvec3 nose = -view.down, wing = view.right;
  const double degrees = 180 / std::acos(-1.0);
  const double heading = std::atan2(nose.x, nose.y) * degrees;
  const double pitch = std::asin(nose.z) * degrees;
  const double roll = std::atan2(-wing.z, -view.into.z) * degrees;
  return view.name + "," +
         text({view.eye.x, view.eye.y, view.eye.z, heading, pitch, roll, kFilm, kPx, kPy}, ",") +
         "," + lens + "\n";
}

constexpr const char* kNames = "#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\n";

TEST(RealityCapturePoses, the_pixels_are_those_of_the_documentation) {
  std::string brown = kNames, division = "#cameras 3\n" + std::string(kNames);
  for (const View& view : kViews) {
    brown += csv_line(view, "-0.23,7.0e-002,-0.01,0.002,3e-003,-0.001");
    division += csv_line(view, "0.2,0,0,0,0,0");
  }
  const auto found = read_pose_texts({{"cameras.csv", brown}});
  expect_pixels(found, realitycapture_brown);
  EXPECT_EQ(found->format, PoseFormat::realitycapture);
  EXPECT_EQ(found->photographs[0].calibration.width, 0);
  expect_pixels(read_pose_texts({{"cameras.csv", division}}), realitycapture_division);
}

TEST(RealityCapturePoses, columns_can_have_another_order) {
  const auto found = read_pose_texts(
      {{"c.csv", "#Name,roll,pitch,yaw,z,y,x,note,f\r\na.jpg,3,2,1,30,20,10,ok,18\r\n"}});
  ASSERT_TRUE(found) << found.error().detail;
  EXPECT_EQ(found->photographs[0].pose.center, glm::dvec3(10, 20, 30));
  EXPECT_EQ(found->photographs[0].calibration.focal, glm::dvec2(0.5));
  EXPECT_EQ(found->photographs[0].calibration.lens.model, LensModel::pinhole);
}

std::string xmp(const std::string& rotation, const std::string& position,
                const std::string& model) {
  return R"(<x:xmpmeta xmlns:x="adobe:ns:meta/"><rdf:RDF xmlns:rdf="http://www.w3.org/1999/02/22-rdf-syntax-ns#">
    <rdf:Description rdf:about="" xmlns:dc="http://purl.org/dc/elements/1.1/" dc:format="image/jpeg"/>
    <rdf:Description xcr:Version="3" xcr:PosePrior="initial" xcr:Coordinates="absolute"
       xcr:DistortionModel=")" +
         model + R"(" xcr:FocalLength35mm="31.5" xcr:Skew="0" xcr:AspectRatio="1"
       xcr:PrincipalPointU="0.0072" xcr:PrincipalPointV="-0.014"
       xmlns:xcr="http://www.capturingreality.com/ns/xcr/1.1#">
      <xcr:Rotation>)" +
         rotation + "</xcr:Rotation><xcr:Position>" + position +
         R"(</xcr:Position>
      <xcr:DistortionCoeficients>-0.23 0.07 -0.01 0.002 0.003 -0.001</xcr:DistortionCoeficients>
    </rdf:Description></rdf:RDF></x:xmpmeta>
)";
}

TEST(RealityCapturePoses, xmp_files_have_the_same_pixels) {
  std::vector<NamedText> files;
  for (const View& view : kViews)
    files.push_back(
        {view.name + ".xmp", xmp(text(view.right) + " " + text(view.down) + " " + text(view.into),
                                 text(view.eye), "brown4t2")});
  files.push_back({"d.jpg.xmp", R"(<x:xmpmeta xmlns:x="adobe:ns:meta/"></x:xmpmeta>)"});
  const auto found = read_pose_texts(files);
  expect_pixels(found, realitycapture_brown);
  EXPECT_EQ(found->without_pose, 1u);
  files[0].content = xmp("1 0 0 0 1 0 0 0 1", "0 0 0", "kbrown3");
  const auto unknown = read_pose_texts(files);
  ASSERT_TRUE(unknown);
  EXPECT_EQ(unknown->refused.size(), 1u);
}

TEST(RealityCapturePoses, a_csv_and_an_xmp_of_the_same_camera_agree) {
  // Both files were published in
  // https://forums.unrealengine.com/t/different-rotation-of-cameras-in-xmp-and-csv/710449. The last
  // number of the matrix was cut after 0.114. Here it follows from the length of its row.
  const auto csv = read_pose_texts(
      {{"c.csv", std::string(kNames) +
                     "a.jpg,0,0,0,163.736597399311,83.4154313461628,174.386496244756,31.5,0,0,"
                     "0,0,0,0,0,0\n"}});
  const auto sidecar =
      read_pose_texts({{"a.xmp", xmp("0.982594073038806 0.185426733553445 -0.0112166890261935 "
                                     "-0.032113633044729 0.11008102707942 -0.993403685341366 "
                                     "-0.18296885582437 0.976472781986697 0.114119690840277",
                                     "0 0 0", "brown3")}});
  ASSERT_TRUE(csv && sidecar);
  for (int column = 0; column < 3; ++column)
    EXPECT_LT(glm::length(csv->photographs[0].pose.camera_from_world[column] -
                          sidecar->photographs[0].pose.camera_from_world[column]),
              1e-13);
}

// ---- Bundler

// P = R X + t, p = -P / P.z, p' = f r(p) p, from the center of the photograph with y up.
glm::dvec2 bundler_pixel(const View& view, const glm::dvec3& point) {
  const glm::dvec3 at = local(view, point);
  const glm::dvec3 upward(at.x, -at.y, -at.z);
  const glm::dvec2 p(-upward.x / upward.z, -upward.y / upward.z);
  const double n2 = glm::dot(p, p);
  const glm::dvec2 pixel = 3500 * (1 - 0.1 * n2 + 0.03 * n2 * n2) * p;
  return {kWidth / 2.0 + pixel.x, kHeight / 2.0 - pixel.y};
}

std::string bundle() {
  std::string out = "# Bundle file v0.3\n4 1\n";
  const auto append_view = [&](const View& view) {
    const glm::dvec3 x = view.right, y = -view.down, z = -view.into;
    out += text({3500, -0.1, 0.03}) + "\n" + text(x) + "\n" + text(y) + "\n" + text(z) + "\n" +
           text({-glm::dot(x, view.eye), -glm::dot(y, view.eye), -glm::dot(z, view.eye)}) + "\n";
  };
  append_view(kViews[0]);
  out += "0 0 0\n0 0 0\n0 0 0\n0 0 0\n0 0 0\n";  // not registered
  append_view(kViews[1]);
  append_view(kViews[2]);
  return out + "1 2 3\n255 255 255\n2 0 1 2.5 -3.5 1 2 3.5 4.5\n";
}
std::string bundle_list() {
  return kViews[0].name + " 0 1234.5\nmissing.jpg\n" + kViews[1].name + "\n" + kViews[2].name +
         " 0 99\n";
}

TEST(BundlerPoses, the_pixels_are_those_of_the_manual) {
  const auto found =
      read_pose_texts({{"bundle/bundle.out", bundle()}, {"list.txt", bundle_list()}});
  expect_pixels(found, bundler_pixel);
  EXPECT_EQ(found->format, PoseFormat::bundler);
  EXPECT_EQ(found->without_pose, 1u);
}

TEST(BundlerPoses, the_list_is_the_file_with_its_name_among_other_texts) {
  const std::vector<NamedText> files{
      {"bundle.out", bundle()}, {"options.txt", "--match_table\n"}, {"list.txt", bundle_list()}};
  const auto found = read_pose_texts(files);
  expect_pixels(found, bundler_pixel);
  EXPECT_THAT(found->unused_files, ElementsAre("options.txt"));
}

}  // namespace
}  // namespace strata::photo
