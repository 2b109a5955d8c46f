#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/ids.h"
#include "domain/people/visibility.h"
#include "protocol/messages.h"

namespace strata::net {

class LiveSession;
class LiveSocket;

// The open WebSockets: what concerns the site is told to all, a stopping server says goodbye to
// all, and who signs out is gone everywhere. Thread-safe.
class LiveSockets {
 public:
  // `secret`: what the person showed to come in.
  void add(std::weak_ptr<LiveSocket> socket, std::weak_ptr<LiveSession> session,
           std::string secret);
  // Whichever model they look at.
  void tell_all(const protocol::ServerMessage& message);
  // Whoever looks at the model.
  void tell_model(ModelId model_id, const protocol::ServerMessage& message);
  // Whoever of them sees what is seen so.
  void tell_model(ModelId model_id, Visibility visibility, const protocol::ServerMessage& message);
  // Those of them who see what is seen so, and nothing that fewer see.
  void tell_sight(ModelId model_id, Visibility sight, const protocol::ServerMessage& message);
  // Whoever looks at a model of the project.
  void tell_project(ProjectId project_id, const protocol::ServerMessage& message);
  // The same, of those who see columns that are seen so and no others.
  void tell_project(ProjectId project_id, Visibility sight, const protocol::ServerMessage& message);
  void close_all(int code, const std::string& reason);
  void close_those_of(const std::string& secret, int code, const std::string& reason);
  // Of a person; those that may stay come back by themselves, as who the person is now.
  void close_user(const std::string& user, int code, const std::string& reason);

 private:
  struct Entry {
    std::weak_ptr<LiveSocket> socket;
    std::weak_ptr<LiveSession> session;
    std::string secret;
  };
  void tell_if(const std::function<bool(const LiveSession&)>& chosen,
               const protocol::ServerMessage& message);
  void close_if(const std::function<bool(const Entry&)>& chosen, int code,
                const std::string& reason);

  std::mutex mutex_;
  std::vector<Entry> entries_;
};

}  // namespace strata::net
