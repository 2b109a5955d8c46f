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

// The open WebSockets. Sends messages to all or some of them. Closes all of them when the server
// stops, and closes the connections of a user who signs out. Thread-safe.
class LiveSockets {
 public:
  // `secret` is the credential that the client used to connect.
  void add(std::weak_ptr<LiveSocket> socket, std::weak_ptr<LiveSession> session,
           std::string secret);
  // Sends to all sessions.
  void tell_all(const protocol::ServerMessage& message);
  // Sends to the sessions of the model.
  void tell_model(ModelId model_id, const protocol::ServerMessage& message);
  // Sends to the sessions of the model that can see content with this visibility.
  void tell_model(ModelId model_id, Visibility visibility, const protocol::ServerMessage& message);
  // Sends to the sessions of the model whose most restricted visible content has this visibility.
  void tell_sight(ModelId model_id, Visibility sight, const protocol::ServerMessage& message);
  // Sends to the sessions of the project's models.
  void tell_project(ProjectId project_id, const protocol::ServerMessage& message);
  // Sends to the sessions of the project's models whose most restricted visible columns have this
  // visibility.
  void tell_project(ProjectId project_id, Visibility sight, const protocol::ServerMessage& message);
  void close_all(int code, const std::string& reason);
  void close_those_of(const std::string& secret, int code, const std::string& reason);
  // Closes a user's sessions. Clients that still have access reconnect automatically with the new
  // role.
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
