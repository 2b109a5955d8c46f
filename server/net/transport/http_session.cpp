#include "net/transport/http_session.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/core/detect_ssl.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <charconv>
#include <future>

#include "core/log.h"
#include "core/trace.h"
#include "core/uuid.h"
#include "net/http/origin.h"
#include "net/http/token_bucket.h"
#include "net/transport/client_watch.h"
#include "net/transport/connection_stream.h"
#include "net/transport/on_worker.h"
#include "net/transport/websocket_session.h"

namespace strata::net {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;
using std::chrono::seconds;

constexpr auto kUseResult = asio::as_tuple(asio::use_awaitable);
constexpr seconds kEventPause{1}, kEventPing{15};
constexpr int kMaxEventStreams = 256;
constexpr std::uint32_t kMaxHead = 8192;
// The number of bytes per read of a large body. The default is the size of the header buffer, a few
// kilobytes.
constexpr std::size_t kReadAtOnce = 64 * 1024;
// A body of a refused request up to this size is read, so the connection can stay open.
constexpr std::uint64_t kMaxIgnoredBody = 64 * 1024;
constexpr std::string_view kSubprotocol = "strata.v1";

Method method_of(http::verb verb) {
  switch (verb) {
    case http::verb::get: return Method::get;
    case http::verb::head: return Method::head;
    case http::verb::post: return Method::post;
    case http::verb::put: return Method::put;
    case http::verb::patch: return Method::patch;
    case http::verb::delete_: return Method::remove;
    case http::verb::options: return Method::options;
    default: return Method::unknown;
  }
}

Result<Request> request_of(const http::request<http::empty_body>& head) {
  Request request;
  request.method = method_of(head.method());
  for (const auto& field : head)
    request.headers.emplace_back(to_lower(field.name_string()), std::string(field.value()));
  STRATA_TRY(parse_target(head.target(), request));
  return request;
}

// Refuses requests that two parsers could interpret differently (RFC 9112, sections 3.2 and 6.1).
Result<void> check_framing(const Request& request, unsigned version) {
  const auto count = [&](std::string_view name) {
    return std::ranges::count_if(request.headers,
                                 [&](const auto& header) { return header.first == name; });
  };
  if (count("host") > 1 || (version >= 11 && count("host") == 0))
    return fail(ErrorCode::malformed, "Invalid Host header",
                "A request must have exactly one Host header.", "Host");
  if (count("transfer-encoding") == 0) return {};
  if (version < 11 || count("transfer-encoding") > 1 ||
      to_lower(request.header("transfer-encoding")) != "chunked")
    return fail(ErrorCode::not_implemented, "Unknown transfer encoding",
                "Send the body with a Content-Length or with `Transfer-Encoding: chunked`.",
                "Transfer-Encoding");
  return {};
}

std::string rate_policy(const ServerOptions& options) {
  const auto window_s =
      static_cast<int>(std::ceil(options.request_burst / options.requests_per_second));
  return "\"connection\";q=" + std::to_string(static_cast<int>(options.request_burst)) +
         ";w=" + std::to_string(window_s);
}

// Limits the time to receive a body. The limit is a fixed time plus one second for each received
// kilobyte.
class BodyClock {
 public:
  explicit BodyClock(seconds at_least) : at_least_(at_least) {}
  bool is_over(std::uint64_t bytes) const {
    return std::chrono::steady_clock::now() - begin_ > at_least_ + std::chrono::milliseconds(bytes);
  }
  static Error problem() {
    return {ErrorCode::timed_out, "Body too slow",
            "The server received less than one kilobyte of the body per second. Check the "
            "network and try again.",
            "body"};
  }

 private:
  const seconds at_least_;
  const std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

// Returns the trace of a request. A request with two headers `traceparent` begins a new trace.
TraceContext trace_of(const http::request<http::empty_body>& head) {
  const auto [first, last] = head.equal_range("traceparent");
  if (first == last || std::next(first) != last) return continued_trace({});
  return continued_trace(first->value());
}

// Measures the stages of one request. The time to receive the body depends on the client, so the
// total excludes it.
class RequestTimes {
 public:
  using Clock = std::chrono::steady_clock;

  // Ends the stage that began with the previous call.
  void admitted() { admit_ = next(); }
  void received() { body_ = next(); }
  void handled() { handle_ = next(); }
  Clock::duration total() const { return admit_ + handle_; }

  // Writes one line if the request was slow, if it failed, or if the level of `net` is debug.
  void report(const Request& request, const Response& response,
              std::chrono::milliseconds slow_after) const {
    const bool is_slow = slow_after.count() > 0 && total() >= slow_after;
    const bool has_failed = response.status >= 500;
    const auto level = is_slow || has_failed ? log::Level::info : log::Level::debug;
    if (!log::is_enabled(level)) return;
    const std::string path = request.path_for_log();
    const log::Field fields[] = {{"method", name(request.method)},
                                 {"path", path},
                                 {"status", std::int64_t(response.status)},
                                 {"admit_ms", ms(admit_)},
                                 {"body_ms", ms(body_)},
                                 {"handle_ms", ms(handle_)},
                                 {"total_ms", ms(total())}};
    const TraceScope scope(request.trace.trace);
    log::write(level, has_failed ? "request failed" : is_slow ? "slow request" : "request", fields);
  }

 private:
  Clock::duration next() {
    const auto now = Clock::now();
    return now - std::exchange(last_, now);
  }
  static double ms(Clock::duration duration) {
    return std::chrono::duration<double, std::milli>(duration).count();
  }

  Clock::time_point last_ = Clock::now();
  Clock::duration admit_{}, body_{}, handle_{};
};

class CountAtWork {
 public:
  explicit CountAtWork(std::atomic<int>& count) : count_(count) { ++count_; }
  ~CountAtWork() { --count_; }
  CountAtWork(const CountAtWork&) = delete;
  CountAtWork& operator=(const CountAtWork&) = delete;

 private:
  std::atomic<int>& count_;
};

class HttpSession : public std::enable_shared_from_this<HttpSession> {
 public:
  HttpSession(tcp::socket socket, std::shared_ptr<Connections> connections,
              std::shared_ptr<asio::ssl::context> tls)
      : stream_(std::move(socket)),
        tls_(std::move(tls)),
        connections_(std::move(connections)),
        api_(connections_->api),
        bucket_(api_.options().requests_per_second, api_.options().request_burst),
        policy_(rate_policy(api_.options())) {
    ++api_.metrics().open_connections;
    beast::error_code gone;
    peer_ = connection().socket().remote_endpoint(gone).address().to_string();
  }
  ~HttpSession() {
    if (!connections_->stopping) --api_.metrics().open_connections;
  }

  asio::awaitable<void> run() {
    auto self = shared_from_this();  // the coroutine frame keeps the session alive
    if (tls_) {
      const bool speaks_tls = co_await start_tls();
      if (!speaks_tls) co_return;
    }
    for (bool first = true;; first = false) {
      http::request_parser<http::empty_body> head;
      head.header_limit(kMaxHead);
      head.body_limit(boost::none);
      connection().expires_after(first ? timeouts().head : timeouts().idle);
      auto [error, size] = co_await http::async_read_header(stream_, buffer_, head, kUseResult);
      if (error) {
        co_await refuse_head(error);
        break;
      }
      const bool goes_on = co_await serve(head);
      if (handed_over_) co_return;
      if (!goes_on) break;
    }
    co_await say_goodbye();
  }

 private:
  const Timeouts& timeouts() const { return api_.options().timeouts; }

  // Returns false if the connection must end. Redirects a client that uses plain HTTP on this port.
  asio::awaitable<bool> start_tls() {
    connection().expires_after(timeouts().head);
    auto [error, speaks_tls] = co_await beast::async_detect_ssl(connection(), buffer_, kUseResult);
    if (error) co_return false;
    if (speaks_tls) {
      const auto first = buffer_.cdata();
      auto [refused, used] = co_await stream_.start_tls(*tls_, first);
      if (!refused) buffer_.consume(used);
      co_return !refused;
    }
    http::request_parser<http::empty_body> head;
    head.header_limit(kMaxHead);
    auto [malformed, size] = co_await http::async_read_header(stream_, buffer_, head, kUseResult);
    if (!malformed) {
      Response elsewhere =
          problem_response({ErrorCode::malformed,
                            "Plain HTTP",
                            "This server requires HTTPS. Use https:// instead of http://.",
                            {}});
      const auto host = head.get()[http::field::host];
      if (!host.empty()) {
        elsewhere.status = 308;
        elsewhere.with("Location",
                       "https://" + std::string(host) + std::string(head.get().target()));
      }
      co_await send(elsewhere, method_of(head.get().method()), false);
    }
    co_await say_goodbye();
    co_return false;
  }

  // GCC 12 destroys some objects twice if they are created inside a co_await expression. The
  // callers of these functions therefore pass named locals by reference.
  asio::awaitable<void> refuse_head(beast::error_code error) {
    trace_ = continued_trace({});  // a new trace
    Response refusal;
    if (error == http::error::header_limit) {
      refusal = problem_response({ErrorCode::head_too_large,
                                  "Header too large",
                                  "The header of a request can have at most 8 KiB. Shorten the "
                                  "address or the headers.",
                                  {}});
    } else if (error.category() == http::make_error_code(http::error::bad_method).category() &&
               error != http::error::end_of_stream && error != http::error::partial_message) {
      refusal = problem_response({ErrorCode::malformed,
                                  "Malformed request",
                                  "The server cannot read this as HTTP: " + error.message() + ".",
                                  {}});
    } else {
      co_return;
    }
    co_await send(refusal, Method::get, false);
  }

  // Serves one request. Returns false if the connection must end.
  asio::awaitable<bool> serve(http::request_parser<http::empty_body>& head) {
    const CountAtWork at_work(connections_->requests_at_work);
    const bool keep_alive = head.keep_alive() && !connections_->stopping;
    http_version_ = head.get().version();
    trace_ = trace_of(head.get());
    RequestTimes times;
    auto parsed = request_of(head.get());
    if (parsed)
      if (auto framed = check_framing(*parsed, http_version_); !framed)
        parsed = tl::unexpected(framed.error());
    if (!parsed) {
      Response malformed = problem_response(parsed.error());
      co_return co_await send(malformed, method_of(head.get().method()), false);
    }
    const auto request = std::make_shared<Request>(std::move(*parsed));
    request->peer = peer_;
    request->by_tls = stream_.has_tls();
    request->trace = trace_;
    by_https_ = came_by_https(*request);
    Response response;
    if (!bucket_.take()) {
      response =
          problem_response({ErrorCode::too_many_requests,
                            "Too many requests",
                            "This connection sends too many requests. Wait a second and try again.",
                            {}});
      co_return co_await refuse(head, *request, response, keep_alive);
    }
    if (beast::websocket::is_upgrade(head.get()) && Api::is_live_address(*request))
      co_return co_await upgrade(head, request);

    const Route* route = api_.find_route(*request, response);
    if (!route) co_return co_await refuse(head, *request, response, keep_alive);
    const auto length = head.content_length();
    const std::uint64_t max_body =
        route->body == BodyKind::none ? kMaxIgnoredBody : route->max_body;
    if (length && *length > max_body) {
      response = problem_response(too_large(max_body));
      co_return co_await refuse(head, *request, response, keep_alive);
    }
    const Work admit = [this, request, route](const Respond& respond) {
      const TraceScope traced(request->trace.trace);
      auto refused = api_.admit(*request, *route);
      respond(refused ? std::move(*refused) : empty_response(100));
    };
    response = co_await on_worker(connections_, stream_.get_executor(), admit);
    times.admitted();
    if (response.status != 100) {
      times.report(*request, response, api_.options().slow_after);
      co_return co_await refuse(head, *request, response, keep_alive);
    }

    const bool has_body = !head.is_done();
    if (has_body) {
      if (beast::iequals(head.get()[http::field::expect], "100-continue")) {
        const bool is_sent = co_await send_continue();
        if (!is_sent) co_return false;
      }
      if (!length || *length > kReadAtOnce) buffer_.reserve(kReadAtOnce);
      Error problem;
      bool is_read = false;
      if (route->body == BodyKind::file)
        is_read = co_await read_to_file(head, *request, max_body, problem);
      else
        is_read = co_await read_to_memory(head, *request, max_body, problem);
      buffer_.shrink_to_fit();  // an idle connection needs little memory
      if (!is_read) {
        remove_body_file(*request);
        if (problem.title.empty()) co_return false;  // the connection is broken
        response = problem_response(problem);
        co_return co_await send(response, request->method, false);
      }
    }
    times.received();
    std::shared_ptr<Question> question;
    std::optional<ClientWatch> watch;
    if (route->is_question || route->is_long_edit) {
      question = api_.questions().begin(*request);
      if (route->is_long_edit) question->skip_turns();
      watch.emplace(stream_.get_executor(), connection().socket().native_handle(), question,
                    [connections = connections_] { ++connections->api.metrics().questions_left; });
    }
    const Work handle = [this, request, route, has_body, question](const Respond& respond) {
      const Question::Scope scope(question);
      const TraceScope traced(request->trace.trace);
      if (has_body)
        if (auto refused = api_.admit_again(*request, *route)) return respond(std::move(*refused));
      api_.handle(*request, *route, respond);
    };
    const std::shared_ptr<Question> at_desk = route->is_question ? question : nullptr;
    response = co_await on_worker(connections_, stream_.get_executor(), handle, at_desk);
    watch.reset();
    remove_body_file(*request);
    times.handled();
    api_.metrics().request_times.add(times.total());
    times.report(*request, response, api_.options().slow_after);
    // While a response is streamed, the failing write detects that the client has disconnected.
    if (question) question->let_take_time();
    stream_question_ = response.stream ? std::move(question) : nullptr;
    co_return co_await send(response, request->method, keep_alive);
  }

  static Error too_large(std::uint64_t max_body) {
    return {ErrorCode::too_large, "Body too large",
            "This address accepts a body of at most " + std::to_string(max_body) +
                " bytes. Send a smaller file, or less data in each request.",
            "body"};
  }

  static void remove_body_file(const Request& request) {
    if (request.body_file.empty()) return;
    std::error_code gone_already;
    std::filesystem::remove(request.body_file, gone_already);
  }

  // Sends a response without using the body. Reads a small body, so the connection can stay open.
  asio::awaitable<bool> refuse(http::request_parser<http::empty_body>& head, const Request& request,
                               Response& response, bool keep_alive) {
    const Method method = request.method;
    if (!head.is_done()) {
      const auto length = head.content_length();
      const bool waits = !head.get()[http::field::expect].empty();
      if (!length || *length > kMaxIgnoredBody || waits)
        co_return co_await send(response, method, false);
      Request ignored;
      Error problem;
      const bool is_read = co_await read_to_memory(head, ignored, kMaxIgnoredBody, problem);
      if (!is_read) co_return false;
    }
    co_return co_await send(response, method, keep_alive);
  }

  asio::awaitable<bool> send_continue() {
    static constexpr std::string_view kContinue = "HTTP/1.1 100 Continue\r\n\r\n";
    connection().expires_after(timeouts().stall);
    auto [error, size] = co_await asio::async_write(stream_, asio::buffer(kContinue), kUseResult);
    co_return !error;
  }

  // Returns false and sets `problem` on failure. A problem without a title means that the
  // connection is broken.
  asio::awaitable<bool> read_to_memory(http::request_parser<http::empty_body>& head,
                                       Request& request, std::uint64_t max_body, Error& problem) {
    http::request_parser<http::string_body> parser(std::move(head));
    parser.body_limit(boost::none);
    const BodyClock clock(timeouts().stall);
    while (!parser.is_done()) {
      connection().expires_after(timeouts().stall);
      auto [error, size] = co_await http::async_read_some(stream_, buffer_, parser, kUseResult);
      if (error) {
        problem = body_problem(error);
        co_return false;
      }
      if (clock.is_over(parser.get().body().size())) {
        problem = BodyClock::problem();
        co_return false;
      }
      if (parser.get().body().size() > max_body) {
        problem = too_large(max_body);
        co_return false;
      }
    }
    request.body = std::move(parser.get().body());
    request.body_bytes = request.body.size();
    co_return true;
  }

  asio::awaitable<bool> read_to_file(http::request_parser<http::empty_body>& head, Request& request,
                                     std::uint64_t max_body, Error& problem) {
    http::request_parser<http::file_body> parser(std::move(head));
    parser.body_limit(boost::none);
    request.body_file = api_.options().upload_dir / (to_string(random_uuid()) + ".body");
    beast::error_code file_error;
    parser.get().body().open(request.body_file.c_str(), beast::file_mode::write_new, file_error);
    if (file_error) {
      log::error("upload folder not writable: " + file_error.message());
      problem = {ErrorCode::storage_full,
                 "No space for uploads",
                 "The server cannot write its upload folder: " + file_error.message() + ".",
                 {}};
      co_return false;
    }
    const BodyClock clock(timeouts().stall);
    while (!parser.is_done()) {
      connection().expires_after(timeouts().stall);
      auto [error, size] = co_await http::async_read_some(stream_, buffer_, parser, kUseResult);
      if (error) {
        problem =
            error == boost::system::errc::no_space_on_device
                ? Error{ErrorCode::storage_full, "Disk full",
                        "The disk of the server has no space for this upload. Ask an administrator to "
                        "free disk space.",
                        "body"}
                : body_problem(error);
        co_return false;
      }
      request.body_bytes += size;
      if (clock.is_over(request.body_bytes)) {
        problem = BodyClock::problem();
        co_return false;
      }
      if (request.body_bytes > max_body) {
        problem = too_large(max_body);
        co_return false;
      }
    }
    parser.get().body().close();
    std::error_code size_error;
    // The size does not include the framing of a chunked body.
    request.body_bytes = std::filesystem::file_size(request.body_file, size_error);
    co_return true;
  }

  static Error body_problem(beast::error_code error) {
    const bool malformed =
        error.category() == http::make_error_code(http::error::bad_chunk).category() &&
        error != http::error::partial_message && error != http::error::end_of_stream;
    if (malformed)
      return {ErrorCode::malformed, "Malformed body",
              "The server cannot read the body: " + error.message() + ".", "body"};
    return {};
  }

  template <class Body>
  void put_head(http::response<Body>& message, const Response& response, bool keep_alive) {
    message.version(11);
    message.result(static_cast<unsigned>(response.status));
    message.reason(reason_phrase(response.status));
    message.set(http::field::server, "strata");
    message.insert("traceparent", to_traceparent(trace_));
    for (const auto& [key, value] : security_headers())
      if (response.header(key).empty()) message.insert(key, value);
    // Browsers then use HTTPS for all later requests, even for http links (RFC 6797).
    if (by_https_) message.set(http::field::strict_transport_security, "max-age=31536000");
    const auto now = TokenBucket::Clock::now();
    message.insert("RateLimit-Policy", policy_);
    message.insert("RateLimit", "\"connection\";r=" + std::to_string(bucket_.left(now)) +
                                    ";t=" + std::to_string(bucket_.full_in_s(now)));
    if (response.header("Cache-Control").empty())
      message.set(http::field::cache_control,
                  response.header("ETag").empty() ? "no-store" : "private, no-cache");
    for (const auto& [key, value] : response.headers) message.insert(key, value);
    message.keep_alive(keep_alive);
  }

  template <class Body>
  asio::awaitable<bool> write(http::response<Body>& message) {
    http::response_serializer<Body> serializer(message);
    while (!serializer.is_done()) {
      connection().expires_after(timeouts().stall);
      auto [error, size] = co_await http::async_write_some(stream_, serializer, kUseResult);
      if (error) co_return false;
    }
    co_return message.keep_alive();
  }

  // Returns false if the connection must end.
  asio::awaitable<bool> send(Response& response, Method method, bool keep_alive) {
    api_.metrics().count_request(response.status);
    if (response.problem) api_.metrics().count_problem(*response.problem);
    if (response.stream) co_return co_await send_stream(response, method, keep_alive);
    if (response.events) co_return co_await send_events(response, method, keep_alive);
    if (!response.file.empty()) {
      http::response<http::file_body> message;
      beast::error_code error;
      message.body().open(response.file.c_str(), beast::file_mode::scan, error);
      if (!error) {
        put_head(message, response, keep_alive);
        if (method == Method::head)
          co_return co_await send_head(response, message.body().size(), keep_alive);
        message.prepare_payload();
        co_return co_await write(message);
      }
      response =
          problem_response({ErrorCode::not_found, "Not found", "The file no longer exists.", {}});
    }
    if (method == Method::head)
      co_return co_await send_head(response, std::max(response.bytes.size(), response.body.size()),
                                   keep_alive);
    if (!response.bytes.empty()) {
      http::response<http::vector_body<std::uint8_t>> message;
      put_head(message, response, keep_alive);
      message.body() = std::move(response.bytes);
      message.content_length(message.body().size());
      co_return co_await write(message);
    }
    http::response<http::string_body> message;
    put_head(message, response, keep_alive);
    message.body() = std::move(response.body);
    if (response.status != 204 && response.status != 304)
      message.content_length(message.body().size());
    co_return co_await write(message);
  }

  asio::awaitable<bool> send_head(const Response& response, std::optional<std::uint64_t> length,
                                  bool keep_alive) {
    http::response<http::empty_body> message;
    put_head(message, response, keep_alive);
    if (length && response.status != 204 && response.status != 304) message.content_length(*length);
    co_return co_await write(message);
  }

  // Sends the head of a chunked response without the body.
  asio::awaitable<bool> send_chunked_head(const Response& response) {
    http::response<http::empty_body> message;
    put_head(message, response, true);
    message.chunked(true);
    http::response_serializer<http::empty_body> serializer(message);
    connection().expires_after(timeouts().stall);
    auto [error, size] = co_await http::async_write_header(stream_, serializer, kUseResult);
    co_return !error;
  }

  // A worker produces the bytes and waits until each piece is sent. The number of simultaneous
  // streams is limited, so slow clients cannot occupy all workers. A body of unknown length is sent
  // in chunks. A client of HTTP/1.0, which has no chunks, reads until the connection ends.
  asio::awaitable<bool> send_stream(Response& response, Method method, bool keep_alive) {
    const auto length = response.stream->length;
    if (method == Method::head) co_return co_await send_head(response, length, keep_alive);
    const CountAtWork counted(connections_->streams_at_work);
    if (connections_->streams_at_work > std::max(1, api_.options().worker_threads / 2)) {
      Response refusal = problem_response(
          {ErrorCode::busy,
           "Too many downloads",
           "Too many downloads are running. Try again when another download has ended.",
           {}});
      co_return co_await send(refusal, method, keep_alive);
    }
    const bool in_chunks = !length && http_version_ >= 11;
    bool head_sent = false;
    if (in_chunks)
      head_sent = co_await send_chunked_head(response);
    else
      head_sent = co_await send_head(response, length, true);
    if (!head_sent) co_return false;
    auto whole = std::make_shared<bool>(false);
    auto stream = *response.stream;
    const Work pump = [this, self = shared_from_this(), stream, whole, in_chunks,
                       question = std::move(stream_question_),
                       trace = trace_.trace](const Respond& respond) {
      const Question::Scope scope(question);
      const TraceScope traced(trace);
      std::uint64_t sent = 0;
      bool written = false;
      try {
        written = stream.write([&](std::span<const std::uint8_t> bytes) {
          if (bytes.empty()) return true;  // an empty chunk would end the body
          if ((stream.length && sent + bytes.size() > *stream.length) ||
              !send_piece(bytes, in_chunks))
            return false;
          sent += bytes.size();
          return true;
        });
      } catch (const QuestionEnded&) {
        // The server is stopping. The client detects that the response is incomplete.
      }
      *whole = written && (!stream.length || sent == *stream.length) &&
               (!in_chunks || send_piece({}, true));
      respond(empty_response(200));
    };
    const Response done = co_await on_worker(connections_, stream_.get_executor(), pump);
    const bool framed = length || in_chunks;
    co_return done.status == 200 && *whole&& framed&& keep_alive;
  }

  // Occupies no thread while there are no events. Sends a comment line from time to time, so
  // proxies keep the connection and the server detects a broken one.
  asio::awaitable<bool> send_events(Response& response, Method method, bool keep_alive) {
    response.with("Content-Type", "text/event-stream")
        .with("Cache-Control", "no-store")
        .with("X-Accel-Buffering", "no");
    if (method == Method::head) co_return co_await send_head(response, std::nullopt, keep_alive);
    const CountAtWork counted(connections_->event_streams);
    if (connections_->event_streams > kMaxEventStreams) {
      Response refusal = problem_response(
          {ErrorCode::busy,
           "Too many event streams",
           "Too many clients receive events. Try again when another client has disconnected.",
           {}});
      co_return co_await send(refusal, method, keep_alive);
    }
    const bool in_chunks = http_version_ >= 11;
    bool head_sent = false;
    if (in_chunks)
      head_sent = co_await send_chunked_head(response);
    else
      head_sent = co_await send_head(response, std::nullopt, false);
    if (!head_sent) co_return false;
    const Work ask = [next = response.events->next](const Respond& respond) {
      auto event = next();
      respond(event ? text_response(std::move(*event), "text/event-stream") : empty_response(204));
    };
    asio::steady_timer pause(stream_.get_executor());
    auto last_sent = std::chrono::steady_clock::now();
    for (;;) {
      const Response reply = co_await on_worker(connections_, stream_.get_executor(), ask);
      if (reply.status == 204 || connections_->stopping) break;
      // Another status means that the server is too busy, so the loop tries again.
      std::string text = reply.status == 200 ? reply.body : std::string();
      if (text.empty() && std::chrono::steady_clock::now() - last_sent >= kEventPing)
        text = ":\n\n";
      if (!text.empty()) {
        if (in_chunks) text = as_chunk(text);
        const bool sent = co_await write_text(std::move(text));
        if (!sent) co_return false;
        last_sent = std::chrono::steady_clock::now();
      }
      connection().expires_never();
      pause.expires_after(kEventPause);
      co_await pause.async_wait(kUseResult);
    }
    if (in_chunks) co_await write_text(as_chunk({}));
    co_return false;
  }

  static std::string as_chunk(std::string_view text) {
    char size[20];
    const auto end = std::to_chars(size, size + sizeof size, text.size(), 16).ptr;
    return std::string(size, end).append("\r\n").append(text).append("\r\n");
  }

  asio::awaitable<bool> write_text(std::string text) {
    connection().expires_after(timeouts().stall);
    auto [error, size] = co_await asio::async_write(stream_, asio::buffer(text), kUseResult);
    co_return !error;
  }

  // Runs on a worker and waits until the piece is sent. An empty chunk marks the end of the body.
  bool send_piece(std::span<const std::uint8_t> bytes, bool in_chunks) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    auto data = std::make_shared<std::string>(in_chunks ? as_chunk(text) : std::string(text));
    auto result = std::make_shared<std::promise<bool>>();
    auto future = result->get_future();
    asio::post(stream_.get_executor(), [self = shared_from_this(), data, result] {
      self->connection().expires_after(self->timeouts().stall);
      asio::async_write(self->stream_, asio::buffer(*data),
                        [self, data, result](beast::error_code error, std::size_t) {
                          result->set_value(!error);
                        });
    });
    while (future.wait_for(std::chrono::milliseconds(200)) != std::future_status::ready)
      if (connections_->stopping) return false;
    return future.get();
  }

  asio::awaitable<bool> upgrade(http::request_parser<http::empty_body>& head,
                                const std::shared_ptr<Request>& request) {
    http::token_list offered(head.get()[http::field::sec_websocket_protocol]);
    Response response;
    if (!offered.exists(kSubprotocol)) {
      response = problem_response({ErrorCode::malformed, "Subprotocol missing",
                                   "A live connection needs the subprotocol strata.v1. Send it in "
                                   "Sec-WebSocket-Protocol.",
                                   "Sec-WebSocket-Protocol"});
      co_return co_await send(response, Method::get, false);
    }
    auto entry = std::make_shared<Api::LiveEntry>();
    auto elsewhere = std::make_shared<std::optional<std::string>>();  // set if the model moved
    const Work admit = [this, request, entry, elsewhere](const Respond& respond) {
      const TraceScope traced(request->trace.trace);
      auto may_enter = api_.admit_live(*request);
      if (!may_enter && may_enter.error().code == ErrorCode::moved)
        *elsewhere = may_enter.error().location;
      else if (!may_enter)
        return respond(may_enter.error());
      else
        *entry = std::move(*may_enter);
      respond(empty_response(101));
    };
    response = co_await on_worker(connections_, stream_.get_executor(), admit);
    if (response.status != 101) co_return co_await send(response, Method::get, false);
    api_.metrics().count_request(101);
    handed_over_ = true;
    connection().expires_never();
    if (*elsewhere)
      start_moved_websocket(std::move(stream_), head.release(), connections_,
                            std::move(**elsewhere));
    else
      start_websocket(std::move(stream_), head.release(), connections_, std::move(*entry));
    co_return false;
  }

  // Shuts down the sending side and reads pending data for a moment. An immediate close could
  // destroy the response before the client has read it.
  asio::awaitable<void> say_goodbye() {
    connection().expires_after(seconds(2));
    if (stream_.has_tls()) co_await stream_.end_tls();
    beast::error_code ignored;
    connection().socket().shutdown(tcp::socket::shutdown_send, ignored);
    std::array<char, 4096> rest;
    for (std::uint64_t total = 0; total < (1u << 20);) {
      auto [error, size] = co_await connection().async_read_some(asio::buffer(rest), kUseResult);
      if (error) break;
      total += size;
    }
    connection().close();
  }

  beast::tcp_stream& connection() { return stream_.next_layer(); }

  ConnectionStream stream_;
  const std::shared_ptr<asio::ssl::context> tls_;
  const std::shared_ptr<Connections> connections_;
  Api& api_;
  beast::flat_buffer buffer_;
  TokenBucket bucket_;
  const std::string policy_;                  // RateLimit-Policy header for `bucket_`
  std::string peer_;                          // address of the client
  unsigned http_version_ = 11;                // HTTP version of the request: 10 or 11
  TraceContext trace_ = continued_trace({});  // of the request
  bool by_https_ = false;  // the request used HTTPS, to this server or to a proxy
  bool handed_over_ = false;
  std::shared_ptr<Question> stream_question_;  // the question whose response is being streamed
};

}  // namespace

void start_http_session(tcp::socket socket, std::shared_ptr<Connections> connections,
                        std::shared_ptr<asio::ssl::context> tls) {
  beast::error_code ignored;
  socket.set_option(tcp::no_delay(true), ignored);
  auto executor = socket.get_executor();
  auto session =
      std::make_shared<HttpSession>(std::move(socket), std::move(connections), std::move(tls));
  asio::co_spawn(
      executor, [session] { return session->run(); },
      [](const std::exception_ptr& failure) {
        if (!failure) return;
        try {
          std::rethrow_exception(failure);
        } catch (const std::exception& error) {
          log::error(std::string("a connection failed: ") + error.what());
        }
      });
}

}  // namespace strata::net
