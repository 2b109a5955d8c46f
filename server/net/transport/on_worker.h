#pragma once

#include <boost/asio/async_result.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <functional>
#include <memory>
#include <utility>

#include "net/transport/http_session.h"

namespace strata::net {

using Work = std::function<void(const Respond&)>;

// Runs `work(respond)` on a worker and resumes on `executor` with the response. The response is 503
// if the queue is full. If `question` is set, the question desk runs the work
// (net/http/question_desk.h). The work does not run if the question has ended before its turn. Pass
// a named function, not a lambda inside the co_await expression, because GCC 12 destroys the
// captures of such temporaries twice.
template <class Executor>
boost::asio::awaitable<Response> on_worker(const std::shared_ptr<Connections>& connections,
                                           Executor executor, const Work& work,
                                           const std::shared_ptr<Question>& question) {
  namespace asio = boost::asio;
  auto initiate = [connections, executor, work, question](auto handler) {
    auto waiting = std::make_shared<decltype(handler)>(std::move(handler));
    Respond respond([io = connections->io.lock(), executor, waiting](Response response) {
      asio::post(executor, [waiting, response = std::move(response)]() mutable {
        std::move (*waiting)(std::move(response));
      });
    });
    if (question) {
      auto posted = connections->api.questions().post(question, [work, respond, question] {
        if (const auto over = question->why()) return respond(*over);
        work(respond);
      });
      if (!posted) respond(posted.error());
      return;
    }
    auto& workers = connections->api.workers();
    if (!workers.post([work, respond] { work(respond); }))
      respond(Error{ErrorCode::busy,
                    "Server is busy",
                    "Too many requests are waiting. Try again in a moment.",
                    {}});
  };
  return asio::async_initiate<const asio::use_awaitable_t<>, void(Response)>(std::move(initiate),
                                                                             asio::use_awaitable);
}

template <class Executor>
boost::asio::awaitable<Response> on_worker(const std::shared_ptr<Connections>& connections,
                                           Executor executor, const Work& work) {
  return on_worker(connections, executor, work, std::shared_ptr<Question>());
}

}  // namespace strata::net
