#pragma once

#include <gtest/gtest.h>

#include <condition_variable>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "room/edit.h"
#include "room/room.h"
#include "room/rooms.h"
#include "stream/jpeg_pool.h"
#include "support/test_cluster.h"

namespace strata::test {

// Rooms over a real database and a real renderer, with one small model: a folded surface in
// millimetres.
class RoomTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  // Closes every room and opens the server's parts anew on the same database, as a restart does.
  void restart(std::uint64_t gpu_memory = 0);
  std::shared_ptr<room::Room> room();
  Layer make_layer(ValueType type, int resolution = 2048, const std::string& name = "Layer");

  // SurfaceImages at the model from +z (or `from`), 640 × 480, orthographic or perspective.
  Camera camera(glm::dvec3 from = {0, 0, 1}, bool orthographic = false) const;
  // Of an annotator.
  room::EditRequest stroke(const Layer& layer, double value, std::vector<glm::dvec2> path,
                           double radius_px, const std::string& user = "anna") const;
  room::EditRequest request(const Layer& layer, decltype(room::EditRequest::edit) edit,
                            const std::string& user = "anna") const;
  // Sends and waits until it is durable or refused.
  Result<room::EditAnswer> send(room::EditRequest request);
  // Sends again what was refused for the moment (503), as a client does.
  Result<room::EditAnswer> send_until_taken(const room::EditRequest& request);
  std::future<Result<room::EditAnswer>> start(room::EditRequest request);
  // What the journal holds of the layer, and that the room holds the same.
  void expect_room_equals_journal(const Layer& layer);
  // The picture of the room, once the GPU shows what the journal holds; fails when that never
  // comes.
  void expect_picture_of_journal();

  std::string dsn_;
  Model model_;
  room::RoomOptions options_;
  std::unique_ptr<store::Store> store_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<stream::JpegPool> encoder_;
  std::unique_ptr<room::Rooms> rooms_;
};

bool equal(const TileMap& a, const TileMap& b);

}  // namespace strata::test
