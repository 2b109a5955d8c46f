#include "app/exports/feature_ids.h"

#include <gtest/gtest.h>

namespace strata::app {
namespace {

TEST(FeatureIds, one_id_of_each_number_of_channels_is_for_no_feature) {
  struct Case {
    std::uint32_t count;
    int channels;
    std::uint32_t none;
  };
  for (const Case& each : {Case{1, 1, 0xff}, Case{255, 1, 0xff}, Case{256, 2, 0xffff},
                           Case{65535, 2, 0xffff}, Case{65536, 3, 0xffffff}}) {
    const IdChannels channels = id_channels(each.count);
    EXPECT_EQ(channels.channels, each.channels) << each.count;
    EXPECT_EQ(channels.none, each.none) << each.count;
    EXPECT_GE(channels.none, each.count) << "the highest id is below";
  }
}

TEST(FeatureIds, the_memory_of_features_contains_their_values_twice) {
  mesh::GlbFeatures features;
  features.ids.bytes.resize(1000);
  features.properties.push_back({"name", mesh::FeatureProperty::Texts{std::string(500, 'a'), ""}});
  EXPECT_GE(bytes_of(features), 1000 + 2 * 500u);
  EXPECT_LT(bytes_of(features), 1000 + 2 * 500u + 200);
}

}  // namespace
}  // namespace strata::app
