#include "net/live/model_events.h"

#include <algorithm>

#include "net/auth/session_recheck.h"
#include "net/serialization/activity_serialization.h"
#include "net/transport/server_options.h"
#include "store/content/models.h"
#include "store/content/projects.h"
#include "store/store.h"

namespace strata::net {
namespace {

// A transaction has the time of its start but becomes visible at its end. If a transaction takes
// longer than this, its events may be missed.
constexpr std::chrono::microseconds kMaxLength = std::chrono::seconds(30);
constexpr std::chrono::seconds kCheckEvery{10};
constexpr int kFirstPage = 20;  // usually there are no new events
constexpr int kPage = 200;
constexpr int kMaxPages = 51;  // enough for the events that a reconnecting client missed

std::int64_t microseconds(const store::Activity& line) {
  return std::chrono::duration_cast<std::chrono::microseconds>(line.time.time_since_epoch())
      .count();
}

}  // namespace

ModelEvents::ModelEvents(const RouteContext& context, const Request& request, const Model& model,
                         const std::optional<store::ActivityPlace>& after)
    : context_(context),
      secret_(Authenticator::secret_of(request)),
      role_(request.role()),
      project_(model.project_id),
      model_(model.id),
      last_(after) {
  if (after) sent_us_[after->id] = after->time_us;
}

bool ModelEvents::is_still_welcome() {
  const auto now = std::chrono::steady_clock::now();
  if (now - checked_ < std::min(kCheckEvery, context_.options.timeouts.recheck)) return true;
  checked_ = now;
  const auto model = context_.store.models().find(to_string(model_));
  if (!model) return model.error().code != ErrorCode::not_found;
  return model->project_id == project_ &&
         net::is_still_welcome(context_.auth, secret_, project_, role_);
}

// Returns the newest line first. Returns nothing if the database is unreachable.
std::optional<ModelEvents::Lines> ModelEvents::lines_since(std::int64_t time_us) {
  store::ActivityQuery query;
  query.model = model_;
  Lines lines;
  for (int page = 0; page < kMaxPages; ++page) {
    query.limit = page == 0 ? kFirstPage : kPage;
    auto found = context_.store.projects().activity(project_, role_, query);
    if (!found) return std::nullopt;
    for (store::Activity& line : found->lines) {
      if (microseconds(line) < time_us) return lines;
      lines.push_back(std::move(line));
    }
    if (!found->next) break;
    query.before = found->next;
  }
  return lines;
}

// Marks these lines as sent.
void ModelEvents::remember(const Lines& lines) {
  last_ = store::ActivityPlace{};
  if (!lines.empty()) last_ = {microseconds(lines.front()), lines.front().id};
  for (const store::Activity& line : lines) sent_us_[line.id] = microseconds(line);
}

std::string ModelEvents::tell(const Lines& lines) {
  std::string text;
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    const std::int64_t time = microseconds(*line);
    if (const auto sent = sent_us_.find(line->id); sent != sent_us_.end() && sent->second >= time)
      continue;
    sent_us_[line->id] = time;
    if (time >= last_->time_us) last_ = store::ActivityPlace{time, line->id};
    text += "event: " + line->kind + "\nid: " + to_text(*last_) +
            "\ndata: " + to_json(*line).dump() + "\n\n";
  }
  std::erase_if(sent_us_, [&](const auto& entry) {
    return entry.second + 2 * kMaxLength.count() < last_->time_us;
  });
  return text;
}

std::optional<std::string> ModelEvents::next() {
  if (!is_still_welcome()) return std::nullopt;
  const auto now = std::chrono::duration_cast<std::chrono::microseconds>(
      std::chrono::system_clock::now().time_since_epoch());
  const auto lines = lines_since((last_ ? last_->time_us : now.count()) - kMaxLength.count());
  if (!lines) return std::string();
  if (last_) return tell(*lines);
  remember(*lines);
  // The position for a client that is disconnected before the first event.
  last_->time_us = std::max<std::int64_t>(last_->time_us, now.count());
  return "id: " + to_text(*last_) + "\n\n";
}

}  // namespace strata::net
