#include "bench/http_client.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/http.hpp>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "bench/harness.h"

namespace strata::bench {

namespace http = boost::beast::http;

HttpClient::HttpClient(std::uint16_t port, std::string token)
    : token_(std::move(token)), stream_(context_) {
  stream_.connect({boost::asio::ip::address_v4::loopback(), port});
  stream_.socket().set_option(boost::asio::ip::tcp::no_delay(true));
}

HttpClient::Answer HttpClient::get(const std::string& path) {
  return send(http::verb::get, path, {}, "application/json", {});
}

HttpClient::Answer HttpClient::post(const std::string& path, const std::string& body,
                                    const std::string& accept, const std::string& content_type) {
  return send(http::verb::post, path, body, accept, content_type);
}

HttpClient::Answer HttpClient::send(http::verb verb, const std::string& path,
                                    const std::string& body, const std::string& accept,
                                    const std::string& content_type) {
  http::request<http::string_body> request(verb, "/api/v1" + path, 11, body);
  request.set(http::field::host, "127.0.0.1");
  request.set(http::field::authorization, "Bearer " + token_);
  request.set(http::field::accept, accept);
  if (!body.empty()) request.set(http::field::content_type, content_type);
  request.prepare_payload();
  http::response_parser<http::string_body> answer;
  answer.body_limit(std::uint64_t{1} << 30);
  const double start = now_ms();
  http::write(stream_, request);
  http::read(stream_, buffer_, answer);
  const double elapsed_ms = now_ms() - start;
  if (http::to_status_class(answer.get().result()) != http::status_class::successful) {
    std::fprintf(stderr, "strata-bench: %s: %s\n", path.c_str(),
                 answer.get().body().substr(0, 400).c_str());
    std::exit(1);
  }
  return {std::move(answer.get().body()), elapsed_ms};
}

}  // namespace strata::bench
