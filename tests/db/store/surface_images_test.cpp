#include <gtest/gtest.h>

#include <thread>

#include "core/digest.h"
#include "core/text/hex.h"
#include "store/content/models.h"
#include "store/content/surface_images.h"
#include "store/pg/pg.h"
#include "support/test_cluster.h"

namespace strata::store {
namespace {

using Picture = std::vector<std::uint8_t>;

NewModel model_with(std::vector<NewModel::NewSurfaceImage> images) {
  NewModel fresh;
  fresh.model.project_id = 1;
  fresh.model.name = "bust";
  fresh.geometry = {1, 2, 3};
  fresh.images = std::move(images);
  return fresh;
}

SurfaceImage surface_image_named(ModelId model_id, const std::string& name) {
  SurfaceImage image;
  image.model_id = model_id;
  image.name = name;
  image.media_type = "image/png";
  image.width = 16;
  image.height = 8;
  return image;
}

class SurfaceImages : public ::testing::Test {
 protected:
  std::int64_t count(const char* sql) {
    return PgConnection::connect(dsn_)->query(sql)->integer(0, 0);
  }
  const std::string dsn_ = test::fresh_database();
  std::unique_ptr<Store> store_ = test::open_store(dsn_);
};

TEST_F(SurfaceImages, those_of_an_import_come_back_bit_for_bit_and_the_first_is_shown) {
  const Picture color(3'000'000, 7), infrared(1000, 9);
  const auto model = store_->models()
                         .create(model_with({{"colour", "image/jpeg", color, 4096, 2048},
                                             {"IR", "image/png", infrared, 64, 32}}),
                                 {})
                         .value();
  const auto images = store_->surface_images().of_model(model.id).value();
  ASSERT_EQ(images.size(), 2u);
  EXPECT_EQ(images[0].name, "colour");
  EXPECT_EQ(images[0].media_type, "image/jpeg");
  EXPECT_EQ(images[0].width, 4096);
  EXPECT_EQ(images[0].height, 2048);
  EXPECT_EQ(images[0].bytes, color.size());
  EXPECT_EQ(images[0].sha256, to_hex(sha256(color)));
  EXPECT_TRUE(images[0].visible);
  EXPECT_EQ(images[1].slug, "ir");
  EXPECT_FALSE(images[1].visible);
  EXPECT_TRUE(store_->surface_images().picture(images[0].id).value() == color);
  EXPECT_TRUE(store_->surface_images().picture(images[1].id).value() == infrared);
}

TEST_F(SurfaceImages, they_are_added_changed_and_found_like_layers) {
  const auto model = store_->models().create(model_with({}), {}).value();
  const Picture picture{1, 2, 3};
  auto uv = surface_image_named(model.id, "UV light");
  uv.description = "365 nm — δ";
  uv.opacity = 0.25;
  uv.order = 3;
  uv = store_->surface_images().create(uv, picture).value();
  EXPECT_EQ(uv.slug, "uv-light");
  EXPECT_EQ(
      store_->surface_images().create(surface_image_named(model.id, "UV light"), picture)->slug,
      "uv-light-2");
  EXPECT_EQ(to_json(store_->surface_images().find(model.id, "uv-light").value()), to_json(uv));
  EXPECT_EQ(store_->surface_images().find(model.id, to_string(uv.id))->description, "365 nm — δ");
  auto changed = uv;
  changed.name = "UV";
  changed.visible = false;
  changed.opacity = 1;
  EXPECT_EQ(store_->surface_images().update(changed)->name, "UV");
  EXPECT_EQ(store_->surface_images().update(changed).error().code, ErrorCode::stale);
  EXPECT_EQ(store_->surface_images().find(ModelId(model.id.number() + 1), "uv-light").error().code,
            ErrorCode::not_found);
  EXPECT_EQ(store_->surface_images().of_model(ModelId(model.id.number() + 1)).error().code,
            ErrorCode::not_found);
  EXPECT_EQ(store_->surface_images().of_model(model.id)->front().slug, "uv-light-2")
      << "drawn below, by its order";
}

TEST_F(SurfaceImages, a_picture_goes_with_the_last_that_uses_it) {
  const Picture picture(2'000'000, 5);
  const auto one =
      store_->models().create(model_with({{"colour", "image/png", picture, 8, 8}}), {}).value();
  auto other = model_with({});
  other.geometry = {4};
  const auto two = store_->models().create(other, {}).value();
  const auto image =
      store_->surface_images().create(surface_image_named(two.id, "same"), picture).value();
  EXPECT_EQ(count("SELECT count(*) FROM blobs"), 3);
  ASSERT_TRUE(store_->models().remove(one.id));
  EXPECT_TRUE(store_->surface_images().picture(image.id).value() == picture);
  ASSERT_TRUE(store_->surface_images().remove(image.id));
  EXPECT_EQ(count("SELECT count(*) FROM blobs"), 1);
  EXPECT_EQ(store_->surface_images().remove(image.id).error().code, ErrorCode::not_found);
  EXPECT_EQ(store_->surface_images().picture(image.id).error().code, ErrorCode::not_found);
}

TEST_F(SurfaceImages, what_cannot_be_a_look_is_refused_and_nothing_is_kept) {
  const auto bad = store_->models().create(model_with({{"x", "text/html", {1}, 1, 1}}), {});
  EXPECT_EQ(bad.error().code, ErrorCode::unsupported);
  EXPECT_EQ(store_->models().create(model_with({{"", "image/png", {1}, 1, 1}}), {}).error().code,
            ErrorCode::malformed);
  EXPECT_EQ(store_->models().create(model_with({{"x", "image/png", {1}, 0, 1}}), {}).error().code,
            ErrorCode::invalid);
  EXPECT_EQ(count("SELECT count(*) FROM blobs"), 0);
  EXPECT_EQ(store_->surface_images().create(surface_image_named(77, "x"), Picture{1}).error().code,
            ErrorCode::not_found);
  const auto model = store_->models().create(model_with({}), {}).value();
  auto image = surface_image_named(model.id, "x");
  image.opacity = 1.5;
  EXPECT_EQ(store_->surface_images().create(image, Picture{1}).error().code, ErrorCode::malformed);
  EXPECT_EQ(count("SELECT count(*) FROM blobs"), 1);
}

TEST_F(SurfaceImages, a_model_holds_no_more_than_its_limit_however_many_ask_at_once) {
  const auto model = store_->models().create(model_with({}), {}).value();
  for (int i = 0; i < store::SurfaceImages::kMaxSurfaceImages - 2; ++i)
    ASSERT_TRUE(store_->surface_images().create(surface_image_named(model.id, "n"), Picture{1}));
  std::vector<std::thread> people;
  for (int i = 0; i < 4; ++i)
    people.emplace_back([&] {
      (void)store_->surface_images().create(surface_image_named(model.id, "late"), Picture{1});
    });
  for (auto& person : people) person.join();
  EXPECT_EQ(store_->surface_images().of_model(model.id)->size(),
            static_cast<std::size_t>(store::SurfaceImages::kMaxSurfaceImages));
  EXPECT_EQ(
      store_->surface_images().create(surface_image_named(model.id, "x"), Picture{1}).error().code,
      ErrorCode::conflict);
}

}  // namespace
}  // namespace strata::store
