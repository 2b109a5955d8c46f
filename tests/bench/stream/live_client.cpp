#include "bench/stream/live_client.h"

#include <algorithm>
#include <boost/asio/as_tuple.hpp>
#include <boost/asio/buffer.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/websocket.hpp>
#include <span>
#include <utility>

#include "bench/harness.h"
#include "protocol/frame_header.h"
#include "protocol/parse.h"

namespace strata::bench {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;

constexpr auto kUseResult = asio::as_tuple(asio::use_awaitable);
constexpr std::size_t kMaxMessage = 64u << 20;

// As in web-client/src/net/batch-flow.ts.
constexpr std::size_t kMostUnanswered = 4;
constexpr double kUsualDelay_ms = 50, kLongestRoundTrip_ms = 300;

protocol::CameraUpdate camera_update(const Camera& camera, std::uint64_t seq, bool moving) {
  protocol::CameraUpdate update;
  update.seq = std::int64_t(seq);
  update.view = camera.view;
  update.projection = camera.projection;
  update.width = camera.width;
  update.height = camera.height;
  update.moving = moving;
  return update;
}

}  // namespace

LiveClient::LiveClient(asio::io_context& context, const asio::ip::tcp::endpoint& at,
                       std::uint16_t server_port)
    : socket_(context),
      at_(at),
      server_port_(server_port),
      has_news_(context, asio::steady_timer::time_point::max()),
      quickest_ms_(kLongestRoundTrip_ms) {}

asio::awaitable<void> LiveClient::open(const std::string& model, const std::string& token,
                                       const Camera& camera) {
  auto [unreachable] = co_await beast::get_lowest_layer(socket_).async_connect(at_, kUseResult);
  if (unreachable) co_return lose(unreachable.message());
  beast::get_lowest_layer(socket_).socket().set_option(asio::ip::tcp::no_delay(true));
  socket_.set_option(websocket::stream_base::decorator([&token](websocket::request_type& request) {
    request.set(http::field::authorization, "Bearer " + token);
    request.set(http::field::sec_websocket_protocol, "strata.v1");
  }));
  socket_.read_message_max(kMaxMessage);
  socket_.text(true);
  const std::string host = "127.0.0.1:" + std::to_string(server_port_);
  const std::string path = "/api/v1/models/" + model + "/live";
  auto [refused] = co_await socket_.async_handshake(host, path, kUseResult);
  if (refused) co_return lose(refused.message());
  protocol::Hello hello;
  hello.client = "strata-bench";
  hello.accept = {"jpeg"};
  send(hello);
  image(camera, false);
  asio::co_spawn(socket_.get_executor(), read(), asio::detached);
  while (!has_picture_ && !is_lost_) co_await has_news_.async_wait(kUseResult);
}

void LiveClient::image(const Camera& camera, bool moving) {
  camera_sent_ms_.push_back(now_ms());
  camera_ = protocol::to_text(camera_update(camera, camera_sent_ms_.size(), moving));
  if (!is_writing_) asio::co_spawn(socket_.get_executor(), write(), asio::detached);
}

asio::awaitable<void> LiveClient::newest_camera_shown() {
  while (!is_lost_ && (frames_.empty() || frames_.back().camera_seq < newest_camera()))
    co_await has_news_.async_wait(kUseResult);
}

void LiveClient::begin_stroke(const std::string& layer, const Camera& camera, double value,
                              double radius_px) {
  protocol::StrokeBegin begin;
  begin.id = random_uuid();
  begin.stroke = stroke_ = random_uuid();
  begin.layer = layer;
  begin.camera = camera;
  begin.value = value;
  begin.radius_px = radius_px;
  next_number_ = 0;
  send(begin);
}

void LiveClient::extend_stroke(const std::vector<glm::dvec2>& path, double since_ms) {
  protocol::StrokeExtend extend;
  extend.id = random_uuid();
  extend.stroke = stroke_;
  extend.n = next_number_++;
  extend.path = path;
  unanswered_.push_back(batches_.size());
  batches_.push_back({extend.id, stroke_, extend.n, since_ms, now_ms()});
  send(extend);
}

bool LiveClient::is_behind() const {
  return unanswered_.size() >= kMostUnanswered &&
         now_ms() - batches_[unanswered_.front()].sent_ms > quickest_ms_ + kUsualDelay_ms;
}

void LiveClient::end_stroke() {
  protocol::StrokeEnd end;
  end.id = random_uuid();
  end.stroke = stroke_;
  send(end);
}

void LiveClient::send(const protocol::ClientMessage& message) {
  texts_.push_back(protocol::to_text(message));
  if (!is_writing_) asio::co_spawn(socket_.get_executor(), write(), asio::detached);
}

asio::awaitable<void> LiveClient::write() {
  if (std::exchange(is_writing_, true)) co_return;  // another call already writes
  while (!is_lost_ && (!texts_.empty() || camera_)) {
    std::string text;
    if (texts_.empty()) {
      text = *std::exchange(camera_, std::nullopt);
    } else {
      text = std::move(texts_.front());
      texts_.pop_front();
    }
    auto [error, size] = co_await socket_.async_write(asio::buffer(text), kUseResult);
    if (error) lose(error.message());
  }
  is_writing_ = false;
}

asio::awaitable<void> LiveClient::read() {
  while (is_reading_) {
    auto [error, size] = co_await socket_.async_read(buffer_, kUseResult);
    if (error) co_return lose(error.message());
    bytes_ += size;
    if (socket_.got_text())
      on_text(beast::buffers_to_string(buffer_.data()));
    else
      on_frame(buffer_.data());
    buffer_.consume(buffer_.size());
  }
}

// Hundreds of viewers receive every edit, so messages that this client does not use are not parsed.
void LiveClient::on_text(const std::string& text) {
  const bool is_answer = text.find(R"("op":"applied")") != std::string::npos;
  if (!is_answer && text.find(R"("op":"problem")") == std::string::npos) return;
  const auto message = protocol::parse_server_message(text);
  if (!message) return lose("it sent " + text.substr(0, 200));
  if (const auto* applied = std::get_if<protocol::Applied>(&*message)) {
    const auto found = answered([&](const Batch& batch) {
      return applied->stroke == batch.stroke && applied->n == batch.number;
    });
    if (!found) return;
    batches_[*found].sequence = std::uint64_t(applied->sequence);
    batches_[*found].has_changed = applied->texels_changed.value_or(0) > 0;
  } else if (const auto* problem = std::get_if<protocol::ProblemMessage>(&*message)) {
    if (!answered([&](const Batch& batch) { return problem->ref == to_string(batch.id); }))
      return lose(problem->title + ": " + problem->detail);
    ++refused_;
  }
}

// Returns the batch that a reply belongs to, and removes it from the unanswered batches.
template <class Matches>
std::optional<std::size_t> LiveClient::answered(Matches matches) {
  const auto found = std::find_if(unanswered_.begin(), unanswered_.end(),
                                  [&](std::size_t index) { return matches(batches_[index]); });
  if (found == unanswered_.end()) return std::nullopt;
  const std::size_t index = *found;
  unanswered_.erase(found);
  quickest_ms_ = std::min(quickest_ms_, now_ms() - batches_[index].sent_ms);
  return index;
}

void LiveClient::on_frame(asio::const_buffer message) {
  const auto header = protocol::decode_frame_header(
      {static_cast<const std::uint8_t*>(message.data()), message.size()});
  if (!header) return lose("a frame is not one: " + header.error().detail);
  if (!header->last) return;
  frames_.push_back({now_ms(), header->camera_seq, header->scene_sequence, header->still});
  has_picture_ = has_picture_ || header->still;
  protocol::Ack ack;
  ack.view_id = int(header->view_id);
  ack.frame = header->frame;
  send(ack);
  has_news_.cancel();
}

void LiveClient::leave() {
  lose("left");
  beast::get_lowest_layer(socket_).close();
}

void LiveClient::lose(const std::string& why) {
  if (std::exchange(is_lost_, true)) return;
  why_lost_ = why;
  has_news_.cancel();
}

}  // namespace strata::bench
