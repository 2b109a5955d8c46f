#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

#include "core/text/utf8.h"
#include "media/photographs/posed_photographs.h"
#include "support/pose_files.h"

namespace strata::photo {
namespace {

using test::read_pose_texts;
using testing::HasSubstr;

using Files = std::vector<test::NamedText>;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

// Expects an error with these words in its detail.
void expect_wrong(const Files& files, const std::string& words,
                  ErrorCode code = ErrorCode::invalid) {
  const auto found = read_pose_texts(files);
  ASSERT_FALSE(found) << words;
  EXPECT_EQ(found.error().code, code) << found.error().detail;
  EXPECT_THAT(found.error().detail, HasSubstr(words));
  EXPECT_EQ(found.error().field, "files");
  EXPECT_TRUE(is_utf8(found.error().detail));
}

const std::string kCameras = "1 PINHOLE 40 30 35 35 20 15\n";
const std::string kImages = "1 1 0 0 0 0 0 5 1 a.jpg\n\n2 1 0 0 0 0 1 5 1 b.jpg\n\n";
Files colmap_texts(const std::string& cameras, const std::string& images) {
  return {{"cameras.txt", cameras}, {"images.txt", images}};
}

TEST(MalformedPoses, colmap_texts_are_refused_with_the_line) {
  ASSERT_TRUE(read_pose_texts(colmap_texts(kCameras, kImages)));
  expect_wrong(colmap_texts("# a comment\n1 PINHOLE 40 30 35 35 20\n", kImages),
               "cameras.txt, line 2");
  expect_wrong(colmap_texts("1 PINHOLE 40 30 35 35 20 15 3\n", kImages), "PINHOLE needs 4 numbers");
  expect_wrong(colmap_texts("1 PINHOLE 40 30 nan 35 20 15\n", kImages), "line 1");
  expect_wrong(colmap_texts("1 PINHOLE 40 30 -35 35 20 15\n", kImages), "focal length");
  expect_wrong(colmap_texts("1 PINHOLE 0 30 35 35 20 15\n", kImages), "no size");
  expect_wrong(colmap_texts("1 PINHOLE 99999999999 30 35 35 20 15\n", kImages), "from 1 to");
  expect_wrong(colmap_texts("1 MIRROR 40 30 35\n", kImages), "camera model is unknown");
  expect_wrong(colmap_texts(kCameras + kCameras, kImages), "occurs twice");
  expect_wrong(colmap_texts(kCameras, "1 1 0 0 0 0 0 5 1 a.jpg\n\n2 1 0 0 inf 0 1 5 1 b.jpg\n"),
               "line 3");
  expect_wrong(colmap_texts(kCameras, replaced(kImages, "1 1 0 0 0 0 0 5 1", "1 0 0 0 0 0 0 5 1")),
               "not a camera pose");
  expect_wrong(colmap_texts(kCameras, replaced(kImages, " 1 b.jpg", " 2 b.jpg")), "no camera 2");
  expect_wrong(colmap_texts(kCameras, "# Image list\n1 1 0 0 0 0 0 5 1\n"),
               "name of the photograph");
  expect_wrong(colmap_texts(kCameras, "# Image list\n1 1 0 0 0 0 0 5\n"), "images.txt, line 2");
  expect_wrong(colmap_texts(kCameras, "# Image list\n"), "None of the photographs");
  expect_wrong({{"cameras.txt", kCameras}}, "images.txt of COLMAP is missing");
  expect_wrong({{"images.txt", kImages}}, "cameras.txt of COLMAP is missing");
  Files twice = colmap_texts(kCameras, kImages);
  twice.push_back(twice.front());
  expect_wrong(twice, "several files cameras.txt");
}

template <class Value>
std::string raw(Value value) {
  std::string out(sizeof value, '\0');
  std::memcpy(out.data(), &value, sizeof value);
  return out;
}

std::string binary_cameras(std::uint64_t count, std::int32_t model) {
  std::string out = raw(count) + raw<std::uint32_t>(1) + raw(model) + raw<std::uint64_t>(40) +
                    raw<std::uint64_t>(30);
  for (const double value : {35.0, 35.0, 20.0, 15.0}) out += raw(value);
  return out;
}
std::string binary_images(std::uint64_t count, std::uint64_t points) {
  std::string out = raw(count) + raw<std::uint32_t>(1);
  for (const double value : {1, 0, 0, 0, 0, 0, 5}) out += raw(value);
  return out + raw<std::uint32_t>(1) + std::string("a.jpg\0", 6) + raw(points);
}
Files colmap_binaries(const std::string& cameras, const std::string& images) {
  return {{"cameras.bin", cameras}, {"images.bin", images}};
}

TEST(MalformedPoses, counts_in_binary_files_are_not_trusted) {
  const std::string cameras = binary_cameras(1, 1), images = binary_images(1, 0);
  ASSERT_TRUE(read_pose_texts(colmap_binaries(cameras, images)));
  constexpr std::uint64_t kHuge = 0xffff'ffff'ffff'fff0;
  expect_wrong(colmap_binaries(binary_cameras(kHuge, 1), images),
               "cameras.bin: the file is damaged");
  expect_wrong(colmap_binaries(binary_cameras(0, 1), images), "damaged");
  expect_wrong(colmap_binaries(binary_cameras(1, 17), images), "unknown camera model");
  expect_wrong(colmap_binaries(binary_cameras(1, -1), images), "unknown camera model");
  expect_wrong(colmap_binaries(cameras, binary_images(kHuge, 0)),
               "images.bin: the file is damaged");
  expect_wrong(colmap_binaries(cameras, binary_images(1, kHuge)), "damaged");
  expect_wrong(colmap_binaries(cameras, binary_images(1, kHuge / 24 + 1)), "damaged");
  expect_wrong(colmap_binaries(cameras, images + "x"), "damaged");
  for (std::size_t size = 0; size < cameras.size(); ++size)
    expect_wrong(colmap_binaries(cameras.substr(0, size), images), "damaged");
  for (std::size_t size = 0; size < images.size(); ++size)
    expect_wrong(colmap_binaries(cameras, images.substr(0, size)), "damaged");
  expect_wrong(colmap_binaries(cameras, replaced(images, raw(5.0), raw(std::nan("")))),
               "not a camera pose");
  expect_wrong(colmap_binaries(cameras, raw<std::uint64_t>(0)), "None of the photographs");
  expect_wrong({{"cameras.bin", cameras}}, "images.bin of COLMAP is missing");
}

TEST(MalformedPoses, too_many_photographs_are_refused) {
  std::string images, table = "#name,x,y,alt,heading,pitch,roll,f\n",
                      xml = "<document><chunk><cameras>";
  std::string list, bundle = "# Bundle file v0.3\n20001 0\n";
  std::string many_images = raw<std::uint64_t>(kMaxPosedPhotographs + 1);
  const std::string one_image = binary_images(1, 0).substr(8);
  for (std::size_t i = 0; i <= kMaxPosedPhotographs; ++i) {
    images += "1 1 0 0 0 0 0 5 1 a.jpg\n\n";
    table += "a.jpg,1,2,3,4,5,6,7\n";
    xml += "<camera/>";
    list += "a.jpg\n";
    many_images += one_image;
  }
  const Files all[] = {colmap_texts(kCameras, images),
                       colmap_binaries(binary_cameras(1, 1), many_images),
                       {{"cameras.csv", table}},
                       {{"cameras.xml", xml + "</cameras></chunk></document>"}},
                       {{"bundle.out", bundle}, {"list.txt", list}}};
  for (const Files& files : all) expect_wrong(files, "more than 20000", ErrorCode::too_large);
  images.resize(images.size() / (kMaxPosedPhotographs + 1) * kMaxPosedPhotographs);
  const auto most = read_pose_texts(colmap_texts(kCameras, images));
  ASSERT_TRUE(most);
  EXPECT_EQ(most->photographs.size(), kMaxPosedPhotographs);
}

const std::string kMetashape = R"(<?xml version="1.0" encoding="UTF-8"?>
<document version="1.5.0"><chunk label="C" enabled="true"><sensors>
<sensor id="0" type="frame"><resolution width="40" height="30"/><calibration type="frame" class="adjusted">
<resolution width="40" height="30"/><f>35</f><k1>0.1</k1></calibration></sensor></sensors>
<components active_id="0"><component id="0"><transform><rotation>1 0 0 0 1 0 0 0 1</rotation>
<translation>0 0 0</translation><scale>2</scale></transform></component></components>
<cameras>
<camera id="0" sensor_id="0" component_id="0" label="a">
<transform>1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1</transform></camera>
</cameras></chunk></document>
)";

TEST(MalformedPoses, metashape_files_are_refused_with_the_line) {
  ASSERT_TRUE(read_pose_texts({{"a.xml", kMetashape}}));
  const auto with = [](const std::string& from, const std::string& to) {
    return Files{{"a.xml", replaced(kMetashape, from, to)}};
  };
  expect_wrong(with("0 0 0 1</transform></camera>", "0 0 0 1 2</transform></camera>"),
               "a.xml, line 9");
  expect_wrong(with("<transform>1 0 0 1", "<transform>1 0 nan 1"), "line 9");
  expect_wrong(with("<transform>1 0 0 1", "<transform>-1 0 0 1"), "not a rotation");
  expect_wrong(with("<transform>1 0 0 1", "<transform>0 0 0 1"), "not a rotation");
  expect_wrong(with("<rotation>1 0 0 0", "<rotation>2 0 0 0"), "line 5");
  expect_wrong(with("<rotation>1 0 0 0", "<rotation>1 0 0"), "9 numbers");
  expect_wrong(with("<scale>2", "<scale>0"), "positive scale");
  expect_wrong(with("<scale>2", "<scale>two"), "scale is not a number");
  expect_wrong(with("<f>35", "<f>inf"), "f is not a number");
  expect_wrong(with("<f>35</f>", ""), "focal length");
  expect_wrong(with("width=\"40\" height=\"30\"/><f>", "width=\"0\" height=\"30\"/><f>"),
               "resolution");
  expect_wrong(with("sensor_id=\"0\"", "sensor_id=\"7\""), "missing");
  expect_wrong(with("label=\"a\"", "label=\"\""), "no label");
  expect_wrong(with("<f>35</f>", "<fx>35</fx><fy>35</fy>"), "old PhotoScan");
  expect_wrong(with("</chunk>", "</chunk><chunk/>"), "several chunks");
  expect_wrong(with("chunk label", "shelf label"), "a.xml, line");
  expect_wrong({{"a.xml", "<document/>"}}, "no chunk");
  expect_wrong(with("<transform>1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1</transform>", ""),
               "None of the photographs");
  for (std::size_t size = 40; size < kMetashape.size() - 12; size += 7) {
    const auto found = read_pose_texts({{"a.xml", kMetashape.substr(0, size)}});
    ASSERT_FALSE(found) << size;
    EXPECT_EQ(found.error().code, ErrorCode::invalid);
  }
}

TEST(MalformedPoses, entities_and_huge_trees_are_refused) {
  const std::string entities =
      replaced(kMetashape, "<document",
               "<!DOCTYPE document [<!ENTITY a SYSTEM \"file:///etc/passwd\">]>\n<document");
  expect_wrong({{"a.xml", replaced(entities, "label=\"a\"", "label=\"&a;\"")}}, "document type");
  // Without a document type, an entity is a plain text.
  const auto plain =
      read_pose_texts({{"a.xml", replaced(kMetashape, "label=\"a\"", "label=\"&a;\"")}});
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->photographs[0].name, "&a;");
  const std::string deep = "<document><chunk><cameras>" + std::string(3'000'000, '<');
  expect_wrong({{"a.xml", deep}}, "a.xml, line 1");
  expect_wrong({{"a.xml", deep + std::string(3'000'001, '<')}}, "too many elements",
               ErrorCode::too_large);
  std::string nested;
  for (int i = 0; i < 200'000; ++i) nested += "<group>";
  std::string closed;
  for (int i = 0; i < 200'000; ++i) closed += "</group>";
  const auto found = read_pose_texts(
      {{"a.xml", replaced(kMetashape, "<cameras>\n", "<cameras>" + nested + closed)}});
  EXPECT_TRUE(found);
}

const std::string kTable =
    "#name,x,y,alt,heading,pitch,roll,f,px,py,k1,k2,k3,k4,t1,t2\na.jpg,1,2,3,4,5,6,7,0,0,0,0,0,0,0,0\n";

TEST(MalformedPoses, realitycapture_files_are_refused_with_the_line) {
  ASSERT_TRUE(read_pose_texts({{"a.csv", kTable}}));
  const auto with = [](const std::string& from, const std::string& to) {
    return Files{{"a.csv", "#cameras 1\n" + replaced(kTable, from, to)}};
  };
  expect_wrong(with("a.jpg,1,2", "a.jpg,1"), "a.csv, line 3: the row has 15 values");
  expect_wrong(with("a.jpg,1,2", "a.jpg,1,nan"), "the value of y is not a number");
  expect_wrong(with("a.jpg,1,2", "a.jpg,1,2 m"), "the value of y is not a number");
  expect_wrong(with(",6,7,", ",6,0,"), "focal length");
  expect_wrong(with(",6,7,", ",1e400,7,"), "the value of roll");
  expect_wrong(with("a.jpg,", ","), "name of the photograph");
  expect_wrong(with("alt,", "up,"), "a.csv, line 2: the column alt is missing");
  expect_wrong(with("a.jpg", "\"a.jpg"), "a.csv: ");
  expect_wrong({{"a.csv", kTable.substr(0, kTable.find('\n'))}}, "None of the photographs");
  const std::string xmp =
      R"(<x:xmpmeta><rdf:RDF><rdf:Description xcr:FocalLength35mm="18" xcr:Rotation="1 0 0 0 1 0 0 0 1" xcr:Position="1 2 3"/></rdf:RDF></x:xmpmeta>)";
  ASSERT_TRUE(read_pose_texts({{"a.xmp", xmp}}));
  expect_wrong({{"a.xmp", replaced(xmp, "1 0 0 0 1", "1 0 0 0")}}, "a.xmp, line 1");
  expect_wrong({{"a.xmp", replaced(xmp, "1 0 0 0 1", "1 0 0 0 -1")}}, "not a rotation matrix");
  expect_wrong({{"a.xmp", replaced(xmp, "\"18\"", "\"x\"")}}, "not a number");
  expect_wrong({{"a.xmp", replaced(xmp, "\"18\"", "\"0\"")}}, "focal length");
  expect_wrong({{"a.xmp", "<!DOCTYPE a>" + xmp}}, "document type");
  expect_wrong({{".xmp", xmp}}, "no name");
}

const std::string kBundle = "# Bundle file v0.3\n1 0\n35 0 0\n1 0 0\n0 1 0\n0 0 1\n0 0 -5\n";
Files bundler(const std::string& bundle, const std::string& list = "a.jpg\n") {
  return {{"bundle.out", bundle}, {"list.txt", list}};
}

TEST(MalformedPoses, bundler_files_are_refused_with_the_line) {
  ASSERT_TRUE(read_pose_texts(bundler(kBundle)));
  const auto with = [](const std::string& from, const std::string& to) {
    return bundler(replaced(kBundle, from, to));
  };
  expect_wrong(with("v0.3", "v0.4"), "version 0.3");
  expect_wrong(with("1 0\n35", "one 0\n35"), "bundle.out, line 2");
  expect_wrong(with("1 0\n35", "99999999999999999999 0\n35"), "line 2");
  expect_wrong(with("1 0\n35", "2 0\n35"), "the list has 1 photographs");
  expect_wrong(with("0 1 0\n", "0 nan 0\n"), "bundle.out, line 5");
  expect_wrong(with("0 1 0\n", "0 2 0\n"), "not a rotation");
  expect_wrong(with("35 0 0", "-35 0 0"), "focal length");
  expect_wrong(with("0 0 -5\n", "0 0"), "15 numbers");
  expect_wrong(bundler(kBundle, ""), "list has 0");
  expect_wrong(bundler(kBundle, "a.jpg\n/\n"), "list.txt, line 2");
  expect_wrong({{"bundle.out", kBundle}}, "list.txt of Bundler is missing");
}

TEST(MalformedPoses, other_files_and_several_exports_are_refused) {
  expect_wrong({}, "None of the files");
  expect_wrong({{"a.jpg", "\xff\xd8\xff"}, {"b.txt", "hello"}, {"c.xml", "<svg/>"}, {"empty", ""}},
               "None of the files");
  Files both = colmap_texts(kCameras, kImages);
  both.push_back({"a.csv", kTable});
  expect_wrong(both, "COLMAP and RealityCapture");
  expect_wrong({{"a.xml", kMetashape}, {"b.xml", kMetashape}}, "several files of Metashape");
}

TEST(MalformedPoses, names_are_safe) {
  const auto found =
      read_pose_texts(colmap_texts(kCameras,
                                   "1 1 0 0 0 0 0 5 1 ..\\..\\C:\\a\x01\xff/\xe2\x80\xae"
                                   "b.jpg\n"));
  ASSERT_TRUE(found) << found.error().detail;
  EXPECT_EQ(found->photographs[0].name, "C:/a\xef\xbf\xbd/b.jpg");
  const std::string part(200, 'p');
  std::string path = "1 1 0 0 0 0 0 5 1 ";
  for (int i = 0; i < 20; ++i) path += part + "/";
  const auto shorter = read_pose_texts(colmap_texts(kCameras, path + "b.jpg\n"));
  ASSERT_TRUE(shorter);
  EXPECT_LE(shorter->photographs[0].name.size(), kMaxPhotographName);
  EXPECT_TRUE(shorter->photographs[0].name.ends_with("/b.jpg"));
}

TEST(MalformedPoses, a_rotation_with_rounded_numbers_is_corrected) {
  const auto found = read_pose_texts(
      bundler(replaced(replaced(kBundle, "1 0 0\n0 1 0\n", "0.8 0.6 0\n-0.6 0.8 0\n"),
                       "0.8 0.6 0\n", "0.8001 0.5999 0\n")));
  ASSERT_TRUE(found);
  const glm::dmat3& rotation = found->photographs[0].pose.camera_from_world;
  const glm::dmat3 product = glm::transpose(rotation) * rotation;
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row) EXPECT_NEAR(product[column][row], column == row, 1e-15);
  EXPECT_NEAR(rotation[0][0], 0.8, 2e-4);
}

}  // namespace
}  // namespace strata::photo
