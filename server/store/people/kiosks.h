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
  std::string name;  // name of the screen, such as its location
  NamedPartId tour_id = 0;
  ModelId model_id = 0;
  ProjectId project_id = 0;
  std::string tour, tour_name, model, model_name, project;  // slugs and names
  std::string user;                                         // the user who made the link
  std::chrono::system_clock::time_point created;
  std::optional<std::chrono::system_clock::time_point> expires, last_seen, revoked;
  bool wants_reload = false;  // a reload was requested, and the page was not loaded after that
  std::string phone;      // secret of the link for the phones of visitors; empty without this link
  bool is_phone = false;  // true if it was found by that secret
};

struct NewKiosk {
  // 256 random bits; returned only once, because the store keeps only its SHA-256
  std::string secret;
  Kiosk kiosk;
};

// Links of kiosks. Part of Store, whose rules for threads and errors apply.
class Kiosks {
 public:
  static constexpr std::int64_t kMaxKiosks = 100;  // valid links per tour

  explicit Kiosks(Pool& pool) : pool_(pool) {}

  struct Page {
    // in the order of their creation; invalid links are listed for 30 days
    std::vector<Kiosk> kiosks;
    std::int64_t total = 0;
  };
  // Returns the kiosks of these projects, or of all projects. `after` selects only kiosks with
  // higher ids.
  Result<Page> all(const std::optional<std::vector<ProjectId>>& projects, int limit, int offset,
                   std::int64_t after = 0);
  Result<Kiosk> kiosk(KioskId id);
  Result<std::vector<KioskId>> of_tour(NamedPartId tour_id);  // also of invalid links

  // Returns a `malformed` error for an empty name, `not_found` for an unknown tour, and `conflict`
  // for too many kiosks.
  Result<NewKiosk> create(NamedPartId tour_id, const std::string& name, const std::string& user,
                          std::optional<std::chrono::seconds> lifetime, bool phones = false);
  // Finds a kiosk by its own secret, or by its secret for phones. Returns nothing if the secret is
  // unknown, expired or revoked.
  Result<std::optional<Kiosk>> find(const std::string& secret);
  // Records that the kiosk is running now, to the minute. `loaded` means that its page was loaded
  // just now, which completes a requested reload.
  Result<void> seen(KioskId id, bool loaded);
  Result<void> revoke(KioskId id);       // no effect if it is already revoked
  Result<Kiosk> ask_reload(KioskId id);  // `conflict` if revoked or expired
  // Switches the link for phones on or off. A link that is switched on again has a new secret.
  // Returns a `conflict` error if the link is revoked or expired.
  Result<Kiosk> allow_phones(KioskId id, bool allowed);

 private:
  Pool& pool_;
};

}  // namespace strata::store
