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

// A fixture with rooms on a real database and a real renderer, and one small model: a folded
// surface in millimeters.
class RoomTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  // Closes every room and opens the server's parts again on the same database, as a restart does.
  void restart(std::uint64_t gpu_memory = 0);
  std::shared_ptr<room::Room> room();
  Layer make_layer(ValueType type, int resolution = 2048, const std::string& name = "Layer");

  // Returns a camera that sees the model from `from`, at 640 × 480 pixels.
  Camera camera(glm::dvec3 from = {0, 0, 1}, bool orthographic = false) const;
  // Returns a stroke of an annotator.
  room::EditRequest stroke(const Layer& layer, double value, std::vector<glm::dvec2> path,
                           double radius_px, const std::string& user = "anna") const;
  room::EditRequest request(const Layer& layer, decltype(room::EditRequest::edit) edit,
                            const std::string& user = "anna") const;
  // Sends the edit and waits until it is durable or refused.
  Result<room::EditAnswer> send(room::EditRequest request);
  // Repeats an edit while the server refuses it temporarily (503), as a client does.
  Result<room::EditAnswer> send_until_taken(const room::EditRequest& request);
  std::future<Result<room::EditAnswer>> start(room::EditRequest request);
  // Expects the room's layer to equal the layer in the journal.
  void expect_room_equals_journal(const Layer& layer);
  // Waits until the room's frame shows the content of the journal. Fails after a time limit.
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
