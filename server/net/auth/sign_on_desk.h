#pragma once

#include <functional>
#include <list>
#include <string>
#include <vector>

#include "net/http/worker_pool.h"
#include "sign_on/client.h"
#include "sign_on/config.h"

namespace strata::net {

// The OpenID Connect providers of the server, and the threads that wait for them. A provider that
// is slow then does not block other requests.
class SignOnDesk {
 public:
  explicit SignOnDesk(const std::vector<sign_on::Provider>& providers);

  sign_on::Client* find(const std::string& id);  // null if the provider does not exist
  // Runs the work on a thread of the desk. Returns false if too much work is waiting.
  bool post(std::function<void()> work) { return workers_.post(std::move(work)); }
  void stop() { workers_.stop(); }

 private:
  std::list<sign_on::Client> clients_;
  WorkerPool workers_;
};

}  // namespace strata::net
