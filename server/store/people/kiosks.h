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

// A screen that shows one tour to whoever stands before it.
struct Kiosk {
  KioskId id = 0;
  std::string name;  // where it stands
  NamedPartId tour_id = 0;
  ModelId model_id = 0;
  ProjectId project_id = 0;
  std::string tour, tour_name, model, model_name, project;  // slugs and names
  std::string user;                                         // who made the link
  std::chrono::system_clock::time_point created;
  std::optional<std::chrono::system_clock::time_point> expires, last_seen, revoked;
  bool wants_reload = false;  // it was asked to, and did not come again since
};

struct NewKiosk {
  std::string secret;  // told this once: its SHA-256 is kept, of 256 random bits
  Kiosk kiosk;
};

// Links of kiosks; of a Store, and as thread-safe and blocking as that, with the same Problems for
// what is not there or away.
class Kiosks {
 public:
  static constexpr std::int64_t kMaxKiosks = 100;  // good ones of a tour

  explicit Kiosks(Pool& pool) : pool_(pool) {}

  struct Page {
    std::vector<Kiosk> kiosks;  // in the order in which they were made; bad ones for 30 days
    std::int64_t total = 0;
  };
  // Of these projects, or of all. `after`: only those with higher ids.
  Result<Page> all(const std::optional<std::vector<ProjectId>>& projects, int limit, int offset,
                   std::int64_t after = 0);
  Result<Kiosk> kiosk(KioskId id);
  Result<std::vector<KioskId>> of_tour(NamedPartId tour_id);  // ids, good or not

  // Refused: an empty name (malformed), a tour that is not there (not_found), one too many
  // (conflict).
  Result<NewKiosk> create(NamedPartId tour_id, const std::string& name, const std::string& user,
                          std::optional<std::chrono::seconds> lifetime);
  // Nothing: unknown, expired or revoked.
  Result<std::optional<Kiosk>> find(const std::string& secret);
  // That it is there, to a minute. `loaded`: its page was loaded just now, as it may have been
  // asked to.
  Result<void> seen(KioskId id, bool loaded);
  Result<void> revoke(KioskId id);       // again is the same
  Result<Kiosk> ask_reload(KioskId id);  // conflict: it is revoked or expired

 private:
  Pool& pool_;
};

}  // namespace strata::store
