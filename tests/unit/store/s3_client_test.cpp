#include "store/files/s3_client.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace strata::store {
namespace {

// A server of this machine that sends the same reply to each request, or none.
class Listener {
 public:
  enum class Way { whole, silent, slow };  // slow: a byte each tenth of a second, without end

  explicit Listener(Way way, std::string reply = {})
      : socket_(socket(AF_INET, SOCK_STREAM, 0)), way_(way), reply_(std::move(reply)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), size), 0);
    EXPECT_EQ(listen(socket_, 16), 0);
    EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    url_ = "http://127.0.0.1:" + std::to_string(ntohs(address.sin_port)) + "/bucket";
    thread_ = std::thread([this] { run(); });
  }
  ~Listener() {
    if (thread_.joinable()) end();
    close(socket_);
  }
  const std::string& url() const { return url_; }
  void answer() { way_ = Way::whole; }
  // Ends, and returns the number of all connections, also of those that it has not served.
  int end() {
    ending_ = true;
    thread_.join();
    for (pollfd waiting{socket_, POLLIN, 0}; poll(&waiting, 1, 0) > 0; ++connections_)
      close(accept(socket_, nullptr, nullptr));
    return connections_;
  }

 private:
  static constexpr int kPause_ms = 100;

  void run() {
    while (!ending_) {
      pollfd waiting{socket_, POLLIN, 0};
      if (poll(&waiting, 1, kPause_ms) <= 0) continue;
      const int client = accept(socket_, nullptr, nullptr);
      ++connections_;
      serve(client);
      close(client);
    }
  }
  // Returns when the client has closed the connection, or has the whole reply.
  void serve(int client) {
    std::string request;
    bool has_begun = false;
    while (!ending_) {
      pollfd waiting{client, POLLIN, 0};
      poll(&waiting, 1, kPause_ms);
      std::array<char, 4096> data{};
      if (waiting.revents != 0) {
        const auto count = recv(client, data.data(), data.size(), 0);
        if (count <= 0) return;
        request.append(data.data(), static_cast<std::size_t>(count));
      }
      if (way_ == Way::silent || request.find("\r\n\r\n") == std::string::npos) continue;
      if (way_ == Way::whole) {
        send(client, reply_.data(), reply_.size(), MSG_NOSIGNAL);
        return;
      }
      const std::string piece =
          has_begun ? "x" : "HTTP/1.1 200 OK\r\nContent-Length: 1000000\r\n\r\n";
      if (send(client, piece.data(), piece.size(), MSG_NOSIGNAL) < 0) return;
      has_begun = true;
    }
  }

  const int socket_;
  std::atomic<Way> way_;
  const std::string reply_;
  std::string url_;
  std::atomic<bool> ending_ = false;
  int connections_ = 0;
  std::thread thread_;
};

std::string reply_of(const std::string& status, const std::string& body = {}) {
  return "HTTP/1.1 " + status + "\r\nContent-Length: " + std::to_string(body.size()) +
         "\r\nConnection: close\r\n\r\n" + body;
}

S3Bucket bucket(const Listener& server) {
  return {server.url(), "us-east-1", "an-access-key", "the-secret-key", "", ""};
}

// A server that does not answer is down for so long that no test waits for the end of it.
constexpr S3Patience kShort{
    .connect_ms = 5000, .silent_s = 1, .whole_ms = 1000, .down = std::chrono::hours(1)};
const S3Call kRead{.key = "ab/cd/abcd", .max_reply = 1000};

TEST(S3Client, a_silent_server_fails_later_requests_at_once) {
  Listener server(Listener::Way::silent);
  S3Client client(bucket(server), kShort);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(client.send(kRead).error().code, ErrorCode::unavailable);
  EXPECT_EQ(server.end(), 2) << "only the first request was sent, twice";
}

TEST(S3Client, a_server_that_answers_again_gets_all_requests) {
  Listener server(Listener::Way::silent, reply_of("200 OK", "content"));
  S3Patience patience = kShort;
  patience.silent_s = 2;
  patience.whole_ms = 30'000;
  patience.down = std::chrono::seconds(0);
  S3Client client(bucket(server), patience);
  EXPECT_EQ(client.send(kRead).error().code, ErrorCode::unavailable);
  EXPECT_EQ(client.send(kRead).error().code, ErrorCode::unavailable);
  server.answer();
  for (int i = 0; i < 2; ++i) {
    const auto reply = client.send(kRead);
    ASSERT_TRUE(reply) << reply.error().detail;
    EXPECT_EQ(std::string(reply->body.begin(), reply->body.end()), "content");
  }
  EXPECT_EQ(server.end(), 5) << "two tries, one try while the server is down, and two answers";
}

TEST(S3Client, a_reply_of_single_bytes_ends) {
  const Listener server(Listener::Way::slow);
  S3Client client(bucket(server), kShort);
  EXPECT_EQ(client.send({.key = "ab", .max_reply = 2'000}).error().code, ErrorCode::unavailable);
}

TEST(S3Client, failures_that_may_pass_are_repeated_and_others_are_not) {
  const std::string timeout = "<?xml version=\"1.0\"?><Error><Code>RequestTimeout</Code></Error>";
  for (const auto& [reply, connections] :
       {std::pair(reply_of("503 Slow Down"), 2), std::pair(reply_of("500 Internal Error"), 2),
        std::pair(reply_of("408 Request Timeout"), 2), std::pair(reply_of("400 Bad", timeout), 2),
        std::pair(reply_of("400 Bad", "<Code>InvalidRange</Code>"), 1),
        std::pair(reply_of("403 Forbidden"), 1)}) {
    Listener server(Listener::Way::whole, reply);
    S3Client client(bucket(server), S3Patience());
    const auto sent = client.send(kRead);
    EXPECT_EQ(server.end(), connections) << reply;
    EXPECT_EQ(sent.has_value(), connections == 1) << reply;
  }
}

TEST(S3Client, a_file_that_became_shorter_is_refused_at_once) {
  const Listener server(Listener::Way::silent);
  const auto file = std::filesystem::temp_directory_path() /
                    ("strata-s3-client-test-" + std::to_string(getpid()));
  std::ofstream(file) << std::string(5000, 'a');
  const Content content = content_of(file, {}).value();
  std::filesystem::resize_file(file, 4000);
  S3Patience patient;
  patient.silent_s = 3600;
  patient.whole_ms = 3'600'000;
  S3Client client(bucket(server), patient);
  const auto sent =
      client.send({.method = S3Call::Method::put, .key = "ab/cd/abcd", .body = &content});
  std::filesystem::remove(file);
  ASSERT_FALSE(sent);
  EXPECT_EQ(sent.error().code, ErrorCode::conflict) << sent.error().detail;
}

TEST(S3Client, requests_to_this_machine_use_no_proxy) {
  const Listener server(Listener::Way::whole, reply_of("200 OK"));
  Listener proxy(Listener::Way::silent);
  setenv("http_proxy", proxy.url().c_str(), 1);
  S3Client client(bucket(server), S3Patience());
  const auto sent = client.send(kRead);
  unsetenv("http_proxy");
  EXPECT_TRUE(sent) << sent.error().detail;
  EXPECT_EQ(proxy.end(), 0);
}

}  // namespace
}  // namespace strata::store
