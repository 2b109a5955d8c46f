#pragma once

#include <boost/asio/dispatch.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <future>
#include <type_traits>

namespace strata::room {

using Strand = boost::asio::strand<boost::asio::thread_pool::executor_type>;

// Runs `work` on the strand, and waits for its result.
template <class Work>
auto run_on(const Strand& strand, Work work) {
  using Value = std::invoke_result_t<Work>;
  std::promise<Value> promise;
  auto future = promise.get_future();
  boost::asio::dispatch(strand, [&] {
    if constexpr (std::is_void_v<Value>) {
      work();
      promise.set_value();
    } else {
      promise.set_value(work());
    }
  });
  return future.get();
}

}  // namespace strata::room
