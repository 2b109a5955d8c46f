#include <gtest/gtest.h>

#include "jobs/import_job.h"

namespace strata::jobs {
namespace {

ImportRequest good() {
  ImportRequest request;
  request.files = {{"pot.ply", {}}};
  return request;
}

std::string refused_field(const ImportRequest& request) {
  const auto result = check(request);
  return result ? "" : result.error().field;
}

TEST(ImportRequest, what_a_scan_may_be_asked_for_is_checked_without_its_bytes) {
  EXPECT_TRUE(check(good()));
  for (const int resolution : {2048, 4096, 8192, 16384}) {
    ImportRequest request = good();
    request.resolution = resolution;
    EXPECT_TRUE(check(request)) << resolution;
  }
  for (const int resolution : {-1, 1, 256, 1024, 3000, 32768}) {
    ImportRequest request = good();
    request.resolution = resolution;
    EXPECT_EQ(refused_field(request), "resolution") << resolution;
  }
  for (const char* crs : {"EPSG:", "EPSG:12345678", "epsg:25830", "EPSG:258x0", "25830"}) {
    ImportRequest request = good();
    request.crs = crs;
    EXPECT_EQ(refused_field(request), "crs") << crs;
  }
  ImportRequest far = good();
  far.crs = "EPSG:1234567";
  EXPECT_TRUE(check(far));
  ImportRequest aside = good();
  aside.up = "w";
  EXPECT_EQ(refused_field(aside), "up");
  ImportRequest survey = good();
  survey.object = "Bust";
  EXPECT_EQ(refused_field(survey), "survey_date");
  survey.survey_date = "2019-13";
  EXPECT_EQ(refused_field(survey), "survey_date");
  survey.survey_date = "2019-12";
  EXPECT_TRUE(check(survey));
  survey.object.clear();
  EXPECT_EQ(refused_field(survey), "object");
  survey.object = std::string(201, 'n');
  EXPECT_EQ(refused_field(survey), "object");
  ImportRequest long_name = good();
  long_name.name = std::string(201, 'n');
  EXPECT_EQ(refused_field(long_name), "name");
}

TEST(ImportRequest, the_ending_names_the_format) {
  for (const char* name : {"pot.PLY", "a.b.obj", "pot.stl", "pot.gltf", "pot.GLB", "pot.zip",
                           "folder/pot.ply", "C:\\scans\\pot.Obj"}) {
    ImportRequest request = good();
    request.files[0].filename = name;
    EXPECT_TRUE(check(request)) << name;
  }
  ImportRequest request = good();
  request.files[0].filename = "pot.jpg";
  EXPECT_EQ(check(request).error().code, ErrorCode::unsupported);
  request.files[0].filename = "pot";
  EXPECT_EQ(check(request).error().code, ErrorCode::invalid);
  request.files[0].filename = "";
  EXPECT_EQ(check(request).error().field, "filename");
  request.files.clear();
  EXPECT_EQ(check(request).error().field, "file");
}

TEST(ImportRequest, one_of_several_files_is_the_scan) {
  ImportRequest request = good();
  request.files = {{"Textures/pot.jpg", {}}, {"pot.mtl", {}}, {"pot.obj", {}}, {"more.zip", {}}};
  EXPECT_TRUE(check(request));
  request.files.push_back({"lid.ply", {}});
  const auto two = check(request);
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().code, ErrorCode::invalid);
  EXPECT_NE(two.error().detail.find("pot.obj, lid.ply"), std::string::npos) << two.error().detail;
  request.files = {{"pot.mtl", {}}, {"pot.jpg", {}}};
  EXPECT_EQ(check(request).error().code, ErrorCode::unsupported);
}

}  // namespace
}  // namespace strata::jobs
