#include "net/auth/sign_on_desk.h"

namespace strata::net {
namespace {

constexpr int kThreads = 4;
constexpr std::size_t kMaxWaiting = 64;

}  // namespace

SignOnDesk::SignOnDesk(const std::vector<sign_on::Provider>& providers)
    : workers_(providers.empty() ? 0 : kThreads, kMaxWaiting) {
  for (const sign_on::Provider& provider : providers) clients_.emplace_back(provider);
}

sign_on::Client* SignOnDesk::find(const std::string& id) {
  for (sign_on::Client& client : clients_)
    if (client.provider().id == id) return &client;
  return nullptr;
}

}  // namespace strata::net
