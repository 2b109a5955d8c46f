#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/verb.hpp>
#include <cstdint>
#include <string>

namespace strata::bench {

// One connection to a server on this machine. It stays open, as the connections of scripts do. Any
// response except a success ends the bench.
class HttpClient {
 public:
  struct Answer {
    std::string body;
    double elapsed_ms;  // until the response is complete
  };
  HttpClient(std::uint16_t port, std::string token);

  // Paths are relative to /api/v1.
  Answer get(const std::string& path);
  Answer post(const std::string& path, const std::string& body,
              const std::string& accept = "application/json",
              const std::string& content_type = "application/json");

 private:
  Answer send(boost::beast::http::verb verb, const std::string& path, const std::string& body,
              const std::string& accept, const std::string& content_type);

  const std::string token_;
  boost::asio::io_context context_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_;
};

}  // namespace strata::bench
