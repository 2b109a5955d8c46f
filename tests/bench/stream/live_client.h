#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/basic_stream.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "core/uuid.h"
#include "domain/scene/camera.h"
#include "protocol/messages.h"

namespace strata::bench {

// Counts the bytes read from a socket, including those of the WebSocket protocol.
class WireCounter {
 public:
  std::uint64_t bytes_read() const { return bytes_read_; }

 private:
  friend class boost::beast::rate_policy_access;
  static constexpr std::size_t kNoLimit = std::size_t(-1);
  std::size_t available_read_bytes() const { return kNoLimit; }
  std::size_t available_write_bytes() const { return kNoLimit; }
  void transfer_read_bytes(std::size_t size) { bytes_read_ += size; }
  void transfer_write_bytes(std::size_t) {}
  void on_timer() {}
  std::uint64_t bytes_read_ = 0;
};

// A viewer that acts like the page over a real WebSocket. The newest camera replaces a waiting one,
// and a frame is acknowledged after its last rectangle. Frames are not decoded, so no decoder uses
// the processors of this machine. The client records the times of events without evaluating them.
// Everything runs on the context's thread.
class LiveClient {
 public:
  struct Frame {  // a complete frame
    double at_ms;
    std::uint64_t camera_seq, scene_sequence;
    bool still;  // full quality
  };
  struct Batch {  // a batch of a stroke
    Uuid id, stroke;
    int number;
    double since_ms;  // the time at which the hand moved to its first point
    double sent_ms;
    std::optional<std::uint64_t> sequence = {};  // set once the batch is applied
    bool has_changed = false;                    // has changed at least one texel
  };
  struct Counts {
    std::uint64_t frames = 0, bytes = 0, wire_bytes = 0;  // bytes: of messages
  };

  // `at`: the endpoint of the server, or of a link to it.
  LiveClient(boost::asio::io_context& context, const boost::asio::ip::tcp::endpoint& at,
             std::uint16_t server_port);

  // Connects, sends the hello message and a camera, and waits until the first frame of full quality
  // has arrived or the connection is lost.
  boost::asio::awaitable<void> open(const std::string& model, const std::string& token,
                                    const Camera& camera);
  void image(const Camera& camera, bool moving);
  // Waits until a frame with the newest camera has arrived or the connection is lost.
  boost::asio::awaitable<void> newest_camera_shown();
  void begin_stroke(const std::string& layer, const Camera& camera, double value, double radius_px);
  // `since_ms`: the time at which the hand moved to the first point.
  void extend_stroke(const std::vector<glm::dvec2>& path, double since_ms);
  void end_stroke();
  void stop_reading() { is_reading_ = false; }  // later data stays in the kernel

  void leave();  // closes the connection as a closed page does

  bool has_picture() const { return has_picture_; }
  bool is_lost() const { return is_lost_; }
  const std::string& why_lost() const { return why_lost_; }
  // The number of batches that are neither applied nor refused.
  int unanswered() const { return int(unanswered_.size()); }
  // Whether further points should wait, like the page's (web-client/src/net/batch-flow.ts).
  bool is_behind() const;
  int refused() const { return refused_; }
  Counts counts() const { return {frames_.size(), bytes_, stream().rate_policy().bytes_read()}; }
  const std::vector<Frame>& frames() const { return frames_; }
  const std::vector<Batch>& batches() const { return batches_; }
  std::uint64_t newest_camera() const { return camera_sent_ms_.size(); }
  // Returns the time at which `image` received the camera with this number.
  double camera_sent_ms(std::uint64_t camera_seq) const {
    return camera_sent_ms_.at(camera_seq - 1);
  }

 private:
  using Stream =
      boost::beast::basic_stream<boost::asio::ip::tcp, boost::asio::any_io_executor, WireCounter>;

  boost::asio::awaitable<void> read();
  boost::asio::awaitable<void> write();
  void on_text(const std::string& text);
  void on_frame(boost::asio::const_buffer message);
  template <class Matches>
  std::optional<std::size_t> answered(Matches matches);
  void send(const protocol::ClientMessage& message);
  void lose(const std::string& why);
  const Stream& stream() const { return socket_.next_layer(); }

  boost::beast::websocket::stream<Stream> socket_;
  const boost::asio::ip::tcp::endpoint at_;
  const std::uint16_t server_port_;
  boost::beast::flat_buffer buffer_;
  boost::asio::steady_timer has_news_;  // fires at every frame and at the end
  std::deque<std::string> texts_;       // messages to send, in order
  std::optional<std::string> camera_;   // the newest camera, to send before the messages
  bool is_writing_ = false, is_reading_ = true, is_lost_ = false, has_picture_ = false;
  std::string why_lost_;

  std::vector<Frame> frames_;
  std::vector<double> camera_sent_ms_;
  std::vector<Batch> batches_;
  std::vector<std::size_t> unanswered_;  // indices of a few elements of `batches_`
  Uuid stroke_{};                        // the current stroke
  double quickest_ms_;                   // the shortest time from a batch to its reply
  int next_number_ = 0, refused_ = 0;
  std::uint64_t bytes_ = 0;
};

}  // namespace strata::bench
