#include "net/transport/server.h"

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <thread>
#include <vector>

#include "core/log.h"
#include "net/api/api.h"
#include "net/live/close_codes.h"
#include "net/transport/certificate.h"
#include "net/transport/http_session.h"

namespace strata::net {
namespace {

namespace asio = boost::asio;
namespace fs = std::filesystem;
using asio::ip::tcp;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr seconds kGoodbye{3};  // time for live connections to close
constexpr seconds kAnswers{5};  // time for running requests to finish

template <class Done>
void wait_until(Done done, milliseconds limit) {
  const auto deadline = std::chrono::steady_clock::now() + limit;
  while (!done() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(milliseconds(5));
}

// Deletes the files that a killed server left in the upload folder.
Result<void> prepare_upload_dir(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    return fail(ErrorCode::internal, "Upload folder unavailable",
                "The folder " + folder.string() + " cannot be created: " + error.message() + ".");
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    const std::string extension = entry.path().extension().string();
    std::error_code ignored;
    if (extension == ".body" || extension == ".part" || extension == ".upload" ||
        extension == ".figure")
      fs::remove(entry.path(), ignored);
  }
  return {};
}

Result<tcp::acceptor> listen(asio::io_context& io, const std::string& host, std::uint16_t port) {
  auto refused = [&](const boost::system::error_code& error) {
    return fail(ErrorCode::internal, "Cannot listen",
                "Cannot listen on " + host + ":" + std::to_string(port) + ": " + error.message() +
                    ". Choose another address with --listen.",
                "listen");
  };
  boost::system::error_code error;
  tcp::resolver resolver(io);
  const auto found = resolver.resolve(host, std::to_string(port), tcp::resolver::passive, error);
  if (error || found.empty()) return refused(error);
  const tcp::endpoint endpoint = found.begin()->endpoint();
  tcp::acceptor acceptor(io);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) return refused(error);
  return acceptor;
}

}  // namespace

struct Server::Impl {
  Impl(ServerOptions options, store::Store& store, room::Rooms& rooms, jobs::JobQueue& jobs,
       render::Renderer& renderer, app::TemplateRegistry templates,
       std::optional<Certificate> own_certificate)
      : api(std::move(options), store, rooms, jobs, renderer, std::move(templates)),
        io(std::make_shared<asio::io_context>(api.options().http_threads)),
        connections(new Connections{io, api, 0, 0, false}),
        acceptor(*io),
        certificate(std::move(own_certificate)) {
    if (certificate) api.metrics().certificate_end = certificate->end();
  }

  asio::awaitable<void> accept() {
    for (;;) {
      tcp::socket socket(asio::make_strand(*io));
      auto [error] = co_await acceptor.async_accept(socket, asio::as_tuple(asio::use_awaitable));
      if (connections->stopping) co_return;
      if (error) {
        // The usual reason is the limit of file descriptors. Waits until other connections have
        // closed.
        log::warning("a connection could not be accepted: " + error.message());
        asio::steady_timer pause(*io, milliseconds(100));
        co_await pause.async_wait(asio::as_tuple(asio::use_awaitable));
        continue;
      }
      const auto open = api.metrics().open_connections.load() + api.metrics().open_sockets.load();
      // Closes the socket of a connection above the limit.
      if (open >= static_cast<std::int64_t>(api.options().max_connections)) continue;
      start_http_session(std::move(socket), connections,
                         certificate ? certificate->context() : nullptr);
      if (certificate) api.metrics().certificate_end = certificate->end();
    }
  }

  Api api;
  std::shared_ptr<asio::io_context> io;
  std::shared_ptr<Connections> connections;
  tcp::acceptor acceptor;
  std::optional<Certificate> certificate;  // used only by `accept`
  std::vector<std::thread> threads;
  std::uint16_t port = 0;
  bool stopped = false;
};

Server::Server() = default;
Server::~Server() { stop(); }

std::uint16_t Server::port() const { return impl_->port; }

Result<std::unique_ptr<Server>> Server::start(ServerOptions options, store::Store& store,
                                              room::Rooms& rooms, jobs::JobQueue& jobs,
                                              render::Renderer& renderer) {
  if (!options.owner_token.empty() && options.owner_token.size() < kMinOwnerTokenLength)
    return fail(ErrorCode::invalid, "Owner token too short",
                "STRATA_OWNER_TOKEN must be at least 32 characters long. Create one with `openssl "
                "rand -hex 32`.",
                "STRATA_OWNER_TOKEN");
  STRATA_TRY(prepare_upload_dir(options.upload_dir));
  auto templates = STRATA_TRY(app::TemplateRegistry::load(options.templates_dir));
  std::optional<Certificate> certificate;
  if (!options.tls_chain.empty()) {
    auto loaded = STRATA_TRY(Certificate::load(options.tls_chain, options.tls_key));
    certificate = std::move(loaded);
  }
  const std::string host = options.host;
  const std::uint16_t port = options.port;
  std::unique_ptr<Server> server(new Server);
  server->impl_ = std::make_unique<Impl>(std::move(options), store, rooms, jobs, renderer,
                                         std::move(templates), std::move(certificate));
  Impl& impl = *server->impl_;
  auto acceptor = listen(*impl.io, host, port);
  if (!acceptor) {
    impl.stopped = true;  // no thread is running yet
    return tl::unexpected(acceptor.error());
  }
  impl.acceptor = std::move(*acceptor);
  impl.port = impl.acceptor.local_endpoint().port();
  asio::co_spawn(*impl.io, impl.accept(), asio::detached);
  for (int i = 0; i < impl.api.options().http_threads; ++i)
    impl.threads.emplace_back(
        [io = impl.io, work = asio::make_work_guard(*impl.io)] { io->run(); });
  return server;
}

void Server::stop() {
  if (!impl_ || std::exchange(impl_->stopped, true)) return;
  Impl& impl = *impl_;
  impl.connections->stopping = true;
  asio::post(*impl.io, [&impl] {
    boost::system::error_code ignored;
    impl.acceptor.close(ignored);
  });
  impl.api.questions().end_all({ErrorCode::unavailable,
                                "Server is stopping",
                                "The server is shutting down. Try again when it is running again.",
                                {}});
  impl.api.live_sockets().close_all(kCloseGoingAway, "the server stops");
  wait_until([&] { return impl.api.metrics().open_sockets.load() == 0; }, kGoodbye);
  wait_until([&] { return impl.connections->requests_at_work.load() == 0; }, kAnswers);
  impl.api.stop_workers();
  impl.io->stop();
  for (auto& thread : impl.threads) thread.join();
}

}  // namespace strata::net
