#include "net/live/live_sockets.h"

#include <algorithm>
#include <utility>

#include "net/live/live_session.h"

namespace strata::net {

void LiveSockets::add(std::weak_ptr<LiveSocket> socket, std::weak_ptr<LiveSession> session,
                      std::string secret) {
  std::lock_guard lock(mutex_);
  std::erase_if(entries_, [](const Entry& known) { return known.socket.expired(); });
  entries_.push_back({std::move(socket), std::move(session), std::move(secret)});
}

void LiveSockets::tell_all(const protocol::ServerMessage& message) {
  tell_if([](const LiveSession&) { return true; }, message);
}

void LiveSockets::tell_model(ModelId model_id, const protocol::ServerMessage& message) {
  tell_if([&](const LiveSession& session) { return session.model_id() == model_id; }, message);
}

void LiveSockets::tell_model(ModelId model_id, Visibility visibility,
                             const protocol::ServerMessage& message) {
  tell_if(
      [&](const LiveSession& session) {
        return session.model_id() == model_id && sees(session.role(), visibility);
      },
      message);
}

void LiveSockets::tell_user(ModelId model_id, const std::string& user,
                            const protocol::ServerMessage& message) {
  tell_if(
      [&](const LiveSession& session) {
        return session.model_id() == model_id && session.user() == user;
      },
      message);
}

void LiveSockets::tell_sight(ModelId model_id, Visibility sight,
                             const protocol::ServerMessage& message) {
  tell_if(
      [&](const LiveSession& session) {
        return session.model_id() == model_id && sight_of(session.role()) == sight;
      },
      message);
}

void LiveSockets::tell_project(ProjectId project_id, const protocol::ServerMessage& message) {
  tell_if([&](const LiveSession& session) { return session.project_id() == project_id; }, message);
}

void LiveSockets::tell_project(ProjectId project_id, Visibility sight,
                               const protocol::ServerMessage& message) {
  tell_if(
      [&](const LiveSession& session) {
        return session.project_id() == project_id && sight_of(session.role()) == sight;
      },
      message);
}

void LiveSockets::close_all(int code, const std::string& reason) {
  close_if([](const Entry&) { return true; }, code, reason);
}

void LiveSockets::close_those_of(const std::string& secret, int code, const std::string& reason) {
  close_if([&](const Entry& entry) { return entry.secret == secret; }, code, reason);
}

void LiveSockets::close_user(const std::string& user, int code, const std::string& reason) {
  close_if(
      [&](const Entry& entry) {
        const auto session = entry.session.lock();
        return session && session->user() == user;
      },
      code, reason);
}

void LiveSockets::close_unwelcome(const std::string& user, const MayStay& may_stay, int code,
                                  const std::string& reason) {
  struct Checked {
    std::shared_ptr<LiveSocket> socket;
    std::shared_ptr<LiveSession> session;
    std::string secret;
  };
  std::vector<Checked> all;
  {
    std::lock_guard lock(mutex_);
    for (const Entry& entry : entries_) {
      Checked each{entry.socket.lock(), entry.session.lock(), entry.secret};
      if (each.socket && each.session) all.push_back(std::move(each));
    }
  }
  for (const Checked& each : all)
    if ((user.empty() || each.session->user() == user) &&
        !may_stay(each.secret, each.session->project_id(), each.session->role()))
      each.socket->close(code, reason);
}

bool LiveSockets::has_model(ModelId model_id) {
  return std::ranges::any_of(sessions(),
                             [&](const auto& session) { return session->model_id() == model_id; });
}

bool LiveSockets::has_project(ProjectId project_id) {
  return std::ranges::any_of(
      sessions(), [&](const auto& session) { return session->project_id() == project_id; });
}

std::vector<std::shared_ptr<LiveSession>> LiveSockets::sessions() {
  std::vector<std::shared_ptr<LiveSession>> sessions;
  std::lock_guard lock(mutex_);
  for (const Entry& entry : entries_)
    if (auto session = entry.session.lock()) sessions.push_back(std::move(session));
  return sessions;
}

void LiveSockets::tell_if(const std::function<bool(const LiveSession&)>& chosen,
                          const protocol::ServerMessage& message) {
  for (const auto& session : sessions())
    if (chosen(*session)) session->tell(message);
}

void LiveSockets::close_if(const std::function<bool(const Entry&)>& chosen, int code,
                           const std::string& reason) {
  std::vector<std::shared_ptr<LiveSocket>> sockets;
  {
    std::lock_guard lock(mutex_);
    for (const Entry& entry : entries_)
      if (chosen(entry))
        if (auto socket = entry.socket.lock()) sockets.push_back(std::move(socket));
  }
  for (const auto& socket : sockets) socket->close(code, reason);
}

}  // namespace strata::net
