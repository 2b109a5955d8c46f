#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"
#include "core/ids.h"

namespace strata::store {

class Pool;

// A screen that shows one tour to visitors.
struct Kiosk {
  KioskId id = 0;
  std::string name;  // the place of the screen
  NamedPartId tour_id = 0;
  ModelId model_id = 0;
  ProjectId project_id = 0;
  std::string tour, tour_name, model, model_name, project;  // slugs and names
  std::string user;                                         // the user who made the link
  std::chrono::system_clock::time_point created;
  std::optional<std::chrono::system_clock::time_point> expires, last_seen, revoked;
  bool wants_reload = false;  // a reload was requested, and the page was not loaded since
  std::string phone;          // secret of the link for visitors' phones; empty: none
  bool is_phone = false;      // found by that secret
};

struct NewKiosk {
  std::string secret;  // returned only once: the store keeps its SHA-256; it has 256 random bits
  Kiosk kiosk;
};

// Links of kiosks. Part of Store: thread-safe and blocking as Store is, with the same errors for
// missing or unreachable data.
class Kiosks {
 public:
  static constexpr std::int64_t kMaxKiosks = 100;  // valid ones of a tour

  explicit Kiosks(Pool& pool) : pool_(pool) {}

  struct Page {
    std::vector<Kiosk> kiosks;  // in the order of their creation; invalid ones for 30 days
    std::int64_t total = 0;
  };
  // Returns the kiosks of these projects, or of all. `after`: only those with higher ids.
  Result<Page> all(const std::optional<std::vector<ProjectId>>& projects, int limit, int offset,
                   std::int64_t after = 0);
  Result<Kiosk> kiosk(KioskId id);
  Result<std::vector<KioskId>> of_tour(NamedPartId tour_id);  // ids, valid or not

  // Refused: an empty name (malformed), an unknown tour (not_found), too many kiosks (conflict).
  Result<NewKiosk> create(NamedPartId tour_id, const std::string& name, const std::string& user,
                          std::optional<std::chrono::seconds> lifetime, bool phones = false);
  // Found by its own secret, or by that for phones. Nothing: unknown, expired or revoked.
  Result<std::optional<Kiosk>> find(const std::string& secret);
  // Records that the kiosk is running, to a minute. `loaded`: its page was loaded just now, which
  // ends a requested reload.
  Result<void> seen(KioskId id, bool loaded);
  Result<void> revoke(KioskId id);       // no effect if it is revoked already
  Result<Kiosk> ask_reload(KioskId id);  // conflict: it is revoked or expired
  // Switches the link for phones on or off. Each time it is switched on it has another secret.
  // conflict: as for ask_reload.
  Result<Kiosk> allow_phones(KioskId id, bool allowed);

 private:
  Pool& pool_;
};

}  // namespace strata::store
