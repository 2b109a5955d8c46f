#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "net/live/live_session.h"

namespace strata::net {

// The open WebSockets: what concerns the site is told to all, a stopping server says goodbye to
// all, and who signs out is gone everywhere. Thread-safe.
class LiveSockets {
 public:
  // `secret`: what the person showed to come in.
  void add(std::weak_ptr<LiveSocket> socket, std::weak_ptr<LiveSession> session,
           std::string secret) {
    std::lock_guard lock(mutex_);
    std::erase_if(entries_, [](const Entry& known) { return known.socket.expired(); });
    entries_.push_back({std::move(socket), std::move(session), std::move(secret)});
  }
  // Whichever model they look at.
  void tell_all(const protocol::ServerMessage& message) {
    tell_if([](const LiveSession&) { return true; }, message);
  }
  // Whoever looks at the model.
  void tell_model(std::int64_t model_id, const protocol::ServerMessage& message) {
    tell_if([&](const LiveSession& session) { return session.model_id() == model_id; }, message);
  }
  // Whoever of them sees what is seen so.
  void tell_model(std::int64_t model_id, Visibility visibility,
                  const protocol::ServerMessage& message) {
    tell_if(
        [&](const LiveSession& session) {
          return session.model_id() == model_id && sees(session.role(), visibility);
        },
        message);
  }
  // Those of them who see what is seen so, and nothing that fewer see.
  void tell_sight(std::int64_t model_id, Visibility sight, const protocol::ServerMessage& message) {
    tell_if(
        [&](const LiveSession& session) {
          return session.model_id() == model_id && sight_of(session.role()) == sight;
        },
        message);
  }
  // Whoever looks at a model of the project.
  void tell_project(std::int64_t project_id, const protocol::ServerMessage& message) {
    tell_if([&](const LiveSession& session) { return session.project_id() == project_id; },
            message);
  }
  // The same, of those who see columns that are seen so and no others.
  void tell_project(std::int64_t project_id, Visibility sight,
                    const protocol::ServerMessage& message) {
    tell_if(
        [&](const LiveSession& session) {
          return session.project_id() == project_id && sight_of(session.role()) == sight;
        },
        message);
  }
  void close_all(int code, const std::string& reason) {
    close_if([](const Entry&) { return true; }, code, reason);
  }
  void close_those_of(const std::string& secret, int code, const std::string& reason) {
    close_if([&](const Entry& entry) { return entry.secret == secret; }, code, reason);
  }
  // Of a person; those that may stay come back by themselves, as who the person is now.
  void close_user(const std::string& user, int code, const std::string& reason) {
    close_if(
        [&](const Entry& entry) {
          const auto session = entry.session.lock();
          return session && session->user() == user;
        },
        code, reason);
  }

 private:
  struct Entry {
    std::weak_ptr<LiveSocket> socket;
    std::weak_ptr<LiveSession> session;
    std::string secret;
  };
  template <class Choice>
  void tell_if(Choice chosen, const protocol::ServerMessage& message) {
    std::vector<std::shared_ptr<LiveSession>> sessions;
    {
      std::lock_guard lock(mutex_);
      for (const Entry& entry : entries_)
        if (auto session = entry.session.lock()) sessions.push_back(std::move(session));
    }
    for (const auto& session : sessions)
      if (chosen(*session)) session->tell(message);
  }
  template <class Choice>
  void close_if(Choice chosen, int code, const std::string& reason) {
    std::vector<std::shared_ptr<LiveSocket>> sockets;
    {
      std::lock_guard lock(mutex_);
      for (const Entry& entry : entries_)
        if (chosen(entry))
          if (auto socket = entry.socket.lock()) sockets.push_back(std::move(socket));
    }
    for (const auto& socket : sockets) socket->close(code, reason);
  }

  std::mutex mutex_;
  std::vector<Entry> entries_;
};

}  // namespace strata::net
