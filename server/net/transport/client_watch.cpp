#include "net/transport/client_watch.h"

#include <poll.h>

namespace strata::net {
namespace {

constexpr std::chrono::milliseconds kBetweenLooks{100};

}  // namespace

bool has_gone(int socket) {
  pollfd watched{socket, POLLRDHUP, 0};
  return ::poll(&watched, 1, 0) > 0 &&
         (watched.revents & (POLLRDHUP | POLLHUP | POLLERR | POLLNVAL)) != 0;
}

struct ClientWatch::Watched : std::enable_shared_from_this<Watched> {
  Watched(const boost::asio::any_io_executor& executor, int its_socket,
          std::shared_ptr<Question> its_question, std::function<void()> when_gone)
      : timer(executor),
        socket(its_socket),
        question(std::move(its_question)),
        on_gone(std::move(when_gone)) {}

  void look_later() {
    timer.expires_after(kBetweenLooks);
    timer.async_wait([self = shared_from_this()](const boost::system::error_code& error) {
      if (!error) self->check();
    });
  }
  void check() {
    if (!question) return;
    if (!has_gone(socket)) return look_later();
    question->end(
        {ErrorCode::cancelled, "Client disconnected", "The client has closed its connection.", {}});
    on_gone();
  }

  boost::asio::steady_timer timer;
  const int socket;
  std::shared_ptr<Question> question;
  const std::function<void()> on_gone;
};

ClientWatch::ClientWatch(const boost::asio::any_io_executor& executor, int socket,
                         std::shared_ptr<Question> question, std::function<void()> on_gone)
    : watched_(
          std::make_shared<Watched>(executor, socket, std::move(question), std::move(on_gone))) {
  watched_->look_later();
}

ClientWatch::~ClientWatch() {
  watched_->question.reset();
  watched_->timer.cancel();
}

}  // namespace strata::net
