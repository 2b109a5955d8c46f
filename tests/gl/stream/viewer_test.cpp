#include "stream/viewer.h"

#include <gtest/gtest.h>
#include <turbojpeg.h>

#include <algorithm>
#include <condition_variable>
#include <cstdlib>
#include <list>
#include <mutex>
#include <thread>

#include "protocol/frame_header.h"
#include "stream/link_pace.h"
#include "support/gl_scene.h"

namespace strata::stream {
namespace {

using protocol::FrameHeader;

constexpr int kWidth = 320, kHeight = 240, kResolution = 256;
constexpr auto kPatience = std::chrono::seconds(120);

std::vector<std::uint8_t> decode_jpeg(std::span<const std::uint8_t> jpeg, int& width, int& height) {
  tjhandle handle = tjInitDecompress();
  EXPECT_EQ(tjDecompressHeader(handle, const_cast<unsigned char*>(jpeg.data()), jpeg.size(), &width,
                               &height),
            0);
  std::vector<std::uint8_t> rgba(std::size_t(width) * height * 4);
  EXPECT_EQ(
      tjDecompress2(handle, jpeg.data(), jpeg.size(), rgba.data(), width, 0, height, TJPF_RGBA, 0),
      0);
  tjDestroy(handle);
  return rgba;
}

// A browser that stores the headers and draws every rectangle into its frame.
class Client {
 public:
  Viewer::Send send() {
    return [this](const FrameMessages& messages) {
      std::lock_guard lock(mutex_);
      for (const FrameBytes& message : messages) {
        const auto header = protocol::decode_frame_header(*message);
        ASSERT_TRUE(header) << header.error().detail;
        EXPECT_EQ(header->last, message == messages.back());
        draw(*header, std::span(*message).subspan(protocol::kFrameHeaderBytes));
        rectangles_.push_back(*header);
      }
      frames_.push_back(rectangles_.back());
      changed_.notify_all();
      if (viewer_ && acks_) viewer_->ack(frames_.back().frame);
    };
  }
  void attach(std::shared_ptr<Viewer> viewer, bool acks) {
    std::lock_guard lock(mutex_);
    viewer_ = std::move(viewer);
    acks_ = acks;
    if (acks && !frames_.empty()) viewer_->ack(frames_.back().frame);
  }
  // Waits for a matching frame with a number above `after`.
  template <class Fits>
  FrameHeader wait_for(const Fits& fits, std::uint32_t after = 0) {
    std::unique_lock lock(mutex_);
    FrameHeader found;
    const bool came = changed_.wait_for(lock, kPatience, [&] {
      return std::any_of(frames_.begin(), frames_.end(), [&](const FrameHeader& header) {
        found = header;
        return header.frame > after && fits(header);
      });
    });
    EXPECT_TRUE(came) << "no such frame came";
    return found;
  }
  std::vector<FrameHeader> frames() {
    std::lock_guard lock(mutex_);
    return frames_;
  }
  std::vector<FrameHeader> rectangles_of(std::uint32_t frame) {
    std::lock_guard lock(mutex_);
    std::vector<FrameHeader> found;
    std::copy_if(rectangles_.begin(), rectangles_.end(), std::back_inserter(found),
                 [&](const FrameHeader& header) { return header.frame == frame; });
    return found;
  }
  std::vector<std::uint8_t> picture() {
    std::lock_guard lock(mutex_);
    return picture_;
  }

 private:
  void draw(const FrameHeader& header, std::span<const std::uint8_t> jpeg) {
    int width = 0, height = 0;
    const auto rgba = decode_jpeg(jpeg, width, height);
    ASSERT_EQ(std::uint32_t(width), header.width);
    ASSERT_EQ(std::uint32_t(height), header.height);
    const std::size_t row_bytes = std::size_t(header.full_width) * 4;
    if (header.keyframe) picture_.assign(row_bytes * header.full_height, 0);
    ASSERT_EQ(picture_.size(), row_bytes * header.full_height)
        << "the first frame is the whole picture";
    for (int y = 0; y < height; ++y)
      std::copy_n(rgba.begin() + std::ptrdiff_t(y) * width * 4, width * 4,
                  picture_.begin() + std::ptrdiff_t((header.y + y) * row_bytes + header.x * 4));
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<FrameHeader> rectangles_;
  std::vector<FrameHeader> frames_;  // the header of the last rectangle of each frame
  std::vector<std::uint8_t> picture_;
  std::shared_ptr<Viewer> viewer_;
  bool acks_ = false;
};

class StreamViewer : public ::testing::Test {
 protected:
  StreamViewer() : scene_(test::make_scene(test::bumpy_sphere(12), kResolution)) { load(); }

  void load() {
    model_ = renderer_.add(scene_);
    layer_ = renderer_.add_layer(model_, ValueType::u8, kResolution);
  }
  std::vector<render::LayerStyle> styles(float opacity = 1) const {
    return {
        {layer_, std::make_shared<const Palette>(default_palette(ValueType::u8, true)), opacity}};
  }
  Client& new_client() { return clients_.emplace_back(); }
  static Camera camera(double x) {
    return test::perspective_camera({x, 0.5, 3}, {0, 0, 0}, kWidth, kHeight);
  }
  std::shared_ptr<Viewer> viewer(Client& client, Viewer::Options options = {}, bool acks = true) {
    auto made = Viewer::create({&renderer_.get(), &encoder_}, model_, options, client.send());
    made->set_style({styles(), {}, {}, {}});
    client.attach(made, acks);
    viewers_.push_back(made);
    return made;
  }
  // Paints a dab and notifies the viewer, as a room does.
  void paint(Viewer& viewer, std::int64_t sequence, double x, double y, std::uint32_t value = 2) {
    const auto outcome = renderer_.paint(layer_, test::dab(camera(0), x, y, 12, value));
    ASSERT_FALSE(outcome.tiles.empty());
    viewer.changed({outcome.written_min, outcome.written_max}, sequence);
  }
  // Returns the pixels that a client would get for a new request with the same camera.
  std::vector<std::uint8_t> fresh_picture(const Camera& seen) {
    render::FrameRequest request;
    request.view = renderer_.add_view(model_);
    request.camera = seen;
    request.width = seen.width;
    request.height = seen.height;
    request.style.layers = styles();
    auto pixels = renderer_.draw(request).pixels;
    renderer_->remove_view(request.view);
    return pixels;
  }
  static double mean_difference(const std::vector<std::uint8_t>& a,
                                const std::vector<std::uint8_t>& b) {
    if (a.size() != b.size() || a.empty()) return 1e9;
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
      if (i % 4 != 3) sum += std::abs(int(a[i]) - int(b[i]));
    return sum / (double(a.size()) * 3 / 4);
  }
  static std::vector<std::uint8_t> part_of(const std::vector<std::uint8_t>& picture,
                                           const FrameHeader& rectangle) {
    std::vector<std::uint8_t> part;
    for (std::size_t y = rectangle.y; y < rectangle.y + rectangle.height; ++y) {
      const auto row =
          picture.begin() + std::ptrdiff_t(4 * (y * rectangle.full_width + rectangle.x));
      part.insert(part.end(), row, row + 4 * rectangle.width);
    }
    return part;
  }
  void TearDown() override {
    for (auto& one : viewers_) one->close();
    for (auto& client : clients_) client.attach(nullptr, false);
    viewers_.clear();
  }

  test::TestRenderer renderer_;
  JpegPool encoder_{2};
  test::Scene scene_;
  render::ModelHandle model_ = 0;
  render::LayerHandle layer_ = 0;
  std::vector<std::shared_ptr<Viewer>> viewers_;
  std::list<Client> clients_;  // destroyed after the viewers, which call the clients
};

TEST_F(StreamViewer, a_picture_at_rest_is_refined_and_a_change_is_drawn_at_once) {
  Client& client = new_client();
  auto view = Viewer::create({&renderer_.get(), &encoder_, 16}, model_, {}, client.send());
  view->set_style({styles(), {}, {}, {}});
  client.attach(view, true);
  viewers_.push_back(view);
  view->set_camera(1, camera(0), false);
  const auto plain = client.wait_for([](const FrameHeader&) { return true; });
  const auto refined =
      client.wait_for([](const FrameHeader& header) { return header.keyframe; }, plain.frame);
  EXPECT_TRUE(refined.still);
  const double difference = mean_difference(client.picture(), fresh_picture(camera(0)));
  EXPECT_GT(difference, 0.02) << "edges are smoother than with one sample";
  EXPECT_LT(difference, 3) << "it is the same picture";

  paint(*view, 1, 160, 120);
  const auto painted = client.wait_for(
      [](const FrameHeader& header) { return header.scene_sequence == 1; }, refined.frame);
  EXPECT_FALSE(painted.keyframe) << "a rectangle of the view's own picture";
  const auto again =
      client.wait_for([](const FrameHeader& header) { return header.keyframe; }, painted.frame);
  EXPECT_EQ(again.scene_sequence, 1u);
}

TEST_F(StreamViewer, what_cannot_be_drawn_is_told_once_and_tried_again_when_something_changes) {
  Client& client = new_client();
  std::mutex mutex;
  std::condition_variable changed;
  std::vector<Error> reported;
  auto view = Viewer::create({&renderer_.get(), &encoder_}, model_, {}, client.send(),
                             [&](const Error& why) {
                               std::lock_guard lock(mutex);
                               reported.push_back(why);
                               changed.notify_all();
                             });
  client.attach(view, true);
  viewers_.push_back(view);
  auto without_colors = styles();
  without_colors[0].palette = std::make_shared<const Palette>(Palette{});
  view->set_style({without_colors, {}, {}, {}});
  view->set_camera(1, camera(0), false);
  {
    std::unique_lock lock(mutex);
    ASSERT_TRUE(changed.wait_for(lock, kPatience, [&] { return !reported.empty(); }));
    EXPECT_EQ(reported[0].code, ErrorCode::invalid);
  }
  view->set_camera(2, camera(0.1), false);  // refused again, but not reported again
  view->set_style({styles(), {}, {}, {}});
  client.wait_for([](const FrameHeader& h) { return h.camera_seq == 2; });
  std::lock_guard lock(mutex);
  EXPECT_EQ(reported.size(), 1u);
}

TEST_F(StreamViewer, a_still_camera_gives_one_whole_picture_of_full_quality) {
  Client& client = new_client();
  Viewer::Options options;
  options.view_id = 3;
  options.sequence = 17;
  auto view = viewer(client, options);
  view->set_camera(5, camera(0), false);
  const FrameHeader frame =
      client.wait_for([](const FrameHeader& h) { return h.still && h.camera_seq == 5; });
  EXPECT_TRUE(frame.keyframe);
  EXPECT_TRUE(frame.last);
  EXPECT_EQ(frame.view_id, 3u);
  EXPECT_EQ(frame.scene_sequence, 17u);
  EXPECT_EQ(frame.full_width, std::uint32_t(kWidth));
  EXPECT_EQ(frame.full_height, std::uint32_t(kHeight));
  EXPECT_LT(mean_difference(client.picture(), fresh_picture(camera(0))), 1.5);
  const auto stats = view->stats();
  EXPECT_GE(stats.frames, 1u);
  EXPECT_GT(stats.bytes, protocol::kFrameHeaderBytes);
}

TEST_F(StreamViewer, a_window_beyond_the_limit_is_drawn_smaller_in_the_same_shape) {
  Client& client = new_client();
  Viewer::Options options;
  options.max_width = 200;
  options.max_height = 90;
  viewer(client, options)->set_camera(1, camera(0), false);
  const FrameHeader frame = client.wait_for([](const FrameHeader& h) { return h.still; });
  EXPECT_EQ(frame.full_width, 120u);
  EXPECT_EQ(frame.full_height, 90u);
}

TEST_F(StreamViewer, after_moving_frames_a_picture_of_full_quality_comes_by_itself) {
  Client& client = new_client();
  auto view = viewer(client);
  for (int i = 1; i <= 8; ++i) view->set_camera(i, camera(0.1 * i), true);
  const FrameHeader still =
      client.wait_for([](const FrameHeader& h) { return h.still && h.camera_seq == 8; });
  EXPECT_TRUE(still.keyframe);
  EXPECT_LT(mean_difference(client.picture(), fresh_picture(camera(0.8))), 1.5);
}

TEST_F(StreamViewer, an_edit_sends_only_its_rectangle_and_the_picture_is_whole_again) {
  Client& client = new_client();
  auto view = viewer(client);
  view->set_camera(1, camera(0), false);
  const auto first = client.wait_for([](const FrameHeader& h) { return h.still; });
  // A change of layers may have caused a second complete frame, so the sequence identifies the
  // parts.
  paint(*view, 41, 150, 110);
  const FrameHeader part =
      client.wait_for([](const FrameHeader& h) { return h.scene_sequence == 41; }, first.frame);
  EXPECT_FALSE(part.keyframe);
  EXPECT_TRUE(part.still);
  EXPECT_LT(part.width * part.height, std::uint32_t(kWidth * kHeight / 2));
  EXPECT_EQ(part.x % 16, 0u);
  EXPECT_EQ(part.y % 16, 0u);
  EXPECT_LT(mean_difference(client.picture(), fresh_picture(camera(0))), 1.5);
}

TEST_F(StreamViewer, edits_far_apart_are_one_frame_of_small_rectangles) {
  Client& client = new_client();
  auto view = viewer(client);
  const Camera large = test::perspective_camera({0, 0.5, 3}, {0, 0, 0}, 3 * kWidth, 3 * kHeight);
  view->set_camera(1, large, false);
  const auto first = client.wait_for([](const FrameHeader& h) { return h.still; });
  std::vector<render::StrokeOutcome> outcomes;
  for (const double x : {315.0, 645.0})
    outcomes.push_back(renderer_.paint(layer_, test::dab(large, x, 360, 12, 2)));
  // The GPU is busy. The first change is requested immediately. Its frame takes in all later
  // changes, because it still waits when they come.
  renderer_->run_on_gpu_thread_for_test([&] {
    view->changed({outcomes[0].written_min, outcomes[0].written_max}, 41);
    for (const auto& outcome : outcomes)
      view->changed({outcome.written_min, outcome.written_max}, 42);
  });
  const auto last =
      client.wait_for([](const FrameHeader& h) { return h.scene_sequence == 42; }, first.frame);
  EXPECT_EQ(last.frame, first.frame + 1) << "no frame shows only the first change";
  const auto rectangles = client.rectangles_of(last.frame);
  ASSERT_EQ(rectangles.size(), 2u);
  const auto picture = client.picture(), fresh = fresh_picture(large);
  EXPECT_LT(mean_difference(picture, fresh), 1.5);
  for (const auto& rectangle : rectangles) {
    EXPECT_LT(rectangle.width, std::uint32_t(kWidth));
    EXPECT_LT(mean_difference(part_of(picture, rectangle), part_of(fresh, rectangle)), 1.5);
  }
}

TEST_F(
    StreamViewer,
    a_client_that_does_not_acknowledge_gets_no_more_than_its_window_and_misses_nothing_in_the_end) {
  Client &silent = new_client(), &lively = new_client();
  Viewer::Options options;
  options.window = 2;
  auto slow = viewer(silent, options, false);
  auto quick = viewer(lively, options, true);
  slow->set_camera(1, camera(0), false);
  quick->set_camera(1, camera(0), false);
  silent.wait_for([](const FrameHeader& h) { return h.still; });
  for (int i = 1; i <= 12; ++i) {
    slow->set_camera(1 + i, camera(0.05 * i), false);
    quick->set_camera(1 + i, camera(0.05 * i), false);
    paint(*slow, i, 60 + 15 * i, 120);
    quick->changed_everywhere(i);
  }
  lively.wait_for(
      [](const FrameHeader& h) { return h.still && h.camera_seq == 13 && h.scene_sequence == 12; });
  EXPECT_LE(silent.frames().size(), 2u);
  EXPECT_GT(slow->stats().dropped, 0u);
  silent.attach(slow, true);
  silent.wait_for(
      [](const FrameHeader& h) { return h.still && h.camera_seq == 13 && h.scene_sequence == 12; });
  EXPECT_LT(mean_difference(silent.picture(), fresh_picture(camera(0.6))), 1.5);
}

TEST_F(StreamViewer, who_sees_the_same_is_sent_one_drawing_and_one_encoding) {
  constexpr int kMany = 12;
  render::ViewStyle style;
  style.layers = styles();  // the same objects for all viewers
  std::vector<Client*> clients;
  std::vector<std::shared_ptr<Viewer>> all;
  std::vector<FrameHeader> first;
  for (int i = 0; i < kMany; ++i) {
    clients.push_back(&new_client());
    all.push_back(viewer(*clients.back()));
    all.back()->set_style(style);
    all.back()->set_camera(100 + i, camera(0), false);
  }
  for (auto* client : clients)
    first.push_back(client->wait_for([](const FrameHeader& h) { return h.still; }));
  const auto outcome = renderer_.paint(layer_, test::dab(camera(0), 150, 110, 12, 2));
  const auto before = encoder_.encoded();
  // All viewers are notified while the GPU is busy.
  renderer_->run_on_gpu_thread_for_test([&] {
    for (auto& one : all) one->changed({outcome.written_min, outcome.written_max}, 8);
  });
  for (std::size_t i = 0; i < clients.size(); ++i) {
    const auto part = clients[i]->wait_for(
        [](const FrameHeader& h) { return h.scene_sequence == 8; }, first[i].frame);
    EXPECT_EQ(part.camera_seq, 100 + i) << "numbers are each one's own";
    EXPECT_FALSE(part.keyframe);
    EXPECT_LT(mean_difference(clients[i]->picture(), fresh_picture(camera(0))), 1.5);
  }
  EXPECT_EQ(encoder_.encoded(), before + 1);
}

TEST_F(StreamViewer, frames_that_take_long_are_smaller_while_the_camera_moves) {
  Client& client = new_client();
  Viewer::Options options;
  options.longest_draw = std::chrono::milliseconds(0);
  auto view = viewer(client, options);
  view->set_camera(1, camera(0), true);
  auto last = client.wait_for([](const FrameHeader& h) { return h.camera_seq == 1; });
  EXPECT_EQ(last.full_width, std::uint32_t(kWidth));
  // Frames that are drawn after a long pause count as frames at rest.
  std::uint64_t number = 1;
  while (number < 200 && last.full_width != std::uint32_t(kWidth / 2)) {
    ++number;
    view->set_camera(number, camera(0.02 * double(number)), true);
    last =
        client.wait_for([&](const FrameHeader& h) { return h.camera_seq == number; }, last.frame);
  }
  EXPECT_EQ(last.full_width, std::uint32_t(kWidth / 2));
  view->set_camera(number + 1, camera(0), false);
  const auto still = client.wait_for([](const FrameHeader& h) { return h.still; }, last.frame);
  EXPECT_EQ(still.full_width, std::uint32_t(kWidth));
  EXPECT_LT(mean_difference(client.picture(), fresh_picture(camera(0))), 1.5);
}

TEST_F(StreamViewer,
       over_a_slow_link_a_moving_camera_has_smaller_pictures_and_a_still_one_has_not) {
  Client& client = new_client();
  auto view = viewer(client);
  view->set_camera(1, camera(0), false);
  auto last = client.wait_for([](const FrameHeader& h) { return h.still; });
  client.attach(view, false);
  // All acknowledgements after the first one are late, as with a full buffer.
  std::uint64_t number = 1;
  for (int i = 0; i < 200 && last.full_width == std::uint32_t(kWidth); ++i) {
    ++number;
    view->set_camera(number, camera(0.02 * double(number)), true);
    last =
        client.wait_for([&](const FrameHeader& h) { return h.camera_seq == number; }, last.frame);
    std::this_thread::sleep_for(1.5 * LinkPace::kMaxWait);
    view->ack(client.frames().back().frame);
  }
  EXPECT_LT(last.full_width, std::uint32_t(kWidth));
  EXPECT_EQ(last.full_height * kWidth, last.full_width * kHeight) << "of the same shape";
  client.attach(view, true);
  const auto still = client.wait_for([](const FrameHeader& h) { return h.still; }, last.frame);
  EXPECT_EQ(still.full_width, std::uint32_t(kWidth));
  EXPECT_LT(mean_difference(client.picture(), fresh_picture(camera(0.02 * double(number)))), 1.5);
}

TEST_F(StreamViewer, frames_are_numbered_without_gaps_in_the_order_they_are_sent) {
  Client& client = new_client();
  auto view = viewer(client);
  for (int i = 1; i <= 30; ++i) {
    view->set_camera(i, camera(0.02 * i), i % 3 != 0);
    paint(*view, i, 80 + 5 * i, 100, 1 + i % 5);
  }
  client.wait_for(
      [](const FrameHeader& h) { return h.still && h.camera_seq == 30 && h.scene_sequence == 30; });
  const auto frames = client.frames();
  EXPECT_EQ(frames.front().frame, 1u);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].frame, i + 1);
    EXPECT_GE(frames[i].camera_seq, frames[i - 1].camera_seq);
    EXPECT_GE(frames[i].scene_sequence, frames[i - 1].scene_sequence);
  }
  EXPECT_LT(mean_difference(client.picture(), fresh_picture(camera(0.6))), 1.5);
}

TEST_F(StreamViewer, after_a_lost_context_everything_comes_again) {
  Client& client = new_client();
  auto view = viewer(client);
  view->set_camera(1, camera(0), false);
  const auto before = client.wait_for([](const FrameHeader& h) { return h.still; });
  std::promise<void> lost;
  renderer_->on_context_lost([&lost] { lost.set_value(); });
  renderer_->lose_context_for_test();
  view->set_camera(2, camera(0.3), false);  // the frame may fail, but the viewer must not stop
  ASSERT_EQ(lost.get_future().wait_for(kPatience), std::future_status::ready);
  load();
  view->reset_model(model_, {styles(), {}, {}, {}});
  client.wait_for([](const FrameHeader& h) { return h.still && h.keyframe && h.camera_seq == 2; },
                  before.frame);
  paint(*view, 9, 160, 120);
  client.wait_for([](const FrameHeader& h) { return h.scene_sequence == 9; }, before.frame);
  EXPECT_LT(mean_difference(client.picture(), fresh_picture(camera(0.3))), 1.5);
}

TEST_F(StreamViewer, after_close_nothing_is_sent) {
  Client& client = new_client();
  auto view = viewer(client);
  view->set_camera(1, camera(0), true);
  client.wait_for([](const FrameHeader&) { return true; });
  view->close();
  const auto count = client.frames().size();
  view->set_camera(2, camera(1), false);
  view->changed_everywhere(5);
  // When the other viewer has its frame, a frame of the closed viewer would also have arrived.
  Client& other = new_client();
  viewer(other)->set_camera(1, camera(0), false);
  other.wait_for([](const FrameHeader& h) { return h.still; });
  EXPECT_EQ(client.frames().size(), count);
}

}  // namespace
}  // namespace strata::stream
