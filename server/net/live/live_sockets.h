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
  // Sends to the sessions of one user at the model.
  void tell_user(ModelId model_id, const std::string& user, const protocol::ServerMessage& message);
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
  // Closes the sessions of a user, or of all users if `user` is empty, that may not stay with their
  // secret, project and role. Calls `may_stay`, which may block, without a lock.
  using MayStay = std::function<bool(const std::string& secret, ProjectId project_id, Role role)>;
  void close_unwelcome(const std::string& user, const MayStay& may_stay, int code,
                       const std::string& reason);
  // Return whether a session could receive an event of the model, or of the project.
  bool has_model(ModelId model_id);
  bool has_project(ProjectId project_id);

 private:
  struct Entry {
    std::weak_ptr<LiveSocket> socket;
    std::weak_ptr<LiveSession> session;
    std::string secret;
  };
  std::vector<std::shared_ptr<LiveSession>> sessions();
  void tell_if(const std::function<bool(const LiveSession&)>& chosen,
               const protocol::ServerMessage& message);
  void close_if(const std::function<bool(const Entry&)>& chosen, int code,
                const std::string& reason);

  std::mutex mutex_;
  std::vector<Entry> entries_;
};

}  // namespace strata::net
