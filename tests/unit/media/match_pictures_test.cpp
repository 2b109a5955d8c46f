#include "media/photographs/match_pictures.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace strata::photo {
namespace {

using testing::ElementsAre;

constexpr std::optional<std::size_t> kNone;

std::vector<std::optional<std::size_t>> matched(const std::vector<std::string>& photographs,
                                                const std::vector<std::string>& pictures) {
  return match_pictures(photographs, pictures);
}

TEST(MatchPictures, a_name_finds_its_picture_in_any_order_and_case) {
  EXPECT_THAT(matched({"b.jpg", "A.JPG", "c.jpg"}, {"a.jpg", "B.Jpg"}), ElementsAre(1, 0, kNone));
  EXPECT_THAT(matched({}, {"a.jpg"}), ElementsAre());
  EXPECT_THAT(matched({"a.jpg"}, {}), ElementsAre(kNone));
}

TEST(MatchPictures, extensions_can_be_missing_or_differ) {
  EXPECT_THAT(matched({"IMG_1", "IMG_2.tif", "v1.2_3"}, {"img_2.jpg", "img_1.jpg", "v1.2_3.jpg"}),
              ElementsAre(1, 0, 2));
  // The equal extension comes first.
  EXPECT_THAT(matched({"IMG_1.tif"}, {"IMG_1.jpg", "IMG_1.tif"}), ElementsAre(1));
}

TEST(MatchPictures, folders_distinguish_equal_names) {
  const std::vector<std::string> pictures{"C:\\site\\101MEDIA\\DJI_0001.JPG",
                                          "C:\\site\\100MEDIA\\DJI_0001.JPG"};
  EXPECT_THAT(matched({"100media/DJI_0001.JPG", "/home/a/101MEDIA/DJI_0001.JPG"}, pictures),
              ElementsAre(1, 0));
  EXPECT_THAT(matched({"DJI_0001"}, pictures), ElementsAre(kNone));
}

TEST(MatchPictures, a_picture_belongs_to_one_photograph) {
  EXPECT_THAT(matched({"DJI_0001", "DJI_0001"}, {"DJI_0001.JPG"}), ElementsAre(kNone, kNone));
  EXPECT_THAT(matched({"a/x.jpg", "b/x.jpg"}, {"b/x.jpg"}), ElementsAre(kNone, 0));
}

}  // namespace
}  // namespace strata::photo
