// `strata kiosk` manages the links of screens that show a tour. It runs on the server's machine,
// even while the server is running.
#include <iomanip>
#include <iostream>

#include "cli/subcommands.h"
#include "store/content/models.h"
#include "store/content/named_parts.h"
#include "store/people/kiosks.h"

namespace strata::cli {
namespace {

struct KioskOptions {
  DataOptions data;
  std::string tour, name, url = "http://127.0.0.1:8080";
  std::int64_t kiosk = 0;
  int days = 0;  // 0: no expiry
};

Result<void> create(store::Store& store, const KioskOptions& options) {
  const auto slash = options.tour.find('/');
  if (slash == std::string::npos)
    return fail(ErrorCode::malformed, "Tour missing",
                "Enter the model and the tour as MODEL/TOUR, as in the address of the tour.",
                "tour");
  const auto model = STRATA_TRY(store.models().find(options.tour.substr(0, slash)));
  const auto tour = STRATA_TRY(store.tours().find(model.id, options.tour.substr(slash + 1)));
  std::optional<std::chrono::seconds> lifetime;
  if (options.days > 0) lifetime = std::chrono::hours(24 * options.days);
  const auto made = STRATA_TRY(store.kiosks().create(tour.id, options.name, "owner", lifetime));
  std::cout << "Link for " << made.kiosk.name << ", printed only once:\n"
            << options.url << "/kiosk/" << made.secret << std::endl;
  return {};
}

Result<void> list(store::Store& store, const KioskOptions&) {
  constexpr int kPage = 1000;
  for (int offset = 0;; offset += kPage) {
    const auto page = STRATA_TRY(store.kiosks().all({}, kPage, offset));
    for (const store::Kiosk& kiosk : page.kiosks)
      std::cout << std::left << std::setw(8) << kiosk.id << std::setw(32)
                << kiosk.model + "/" + kiosk.tour << " " << (kiosk.revoked ? "revoked " : "until ")
                << std::setw(12) << day_of(kiosk.revoked ? kiosk.revoked : kiosk.expires)
                << "last seen " << std::setw(12) << day_of(kiosk.last_seen) << kiosk.name << "\n";
    if (offset + kPage >= page.total) return {};
  }
}

Result<void> revoke(store::Store& store, const KioskOptions& options) {
  return store.kiosks().revoke(KioskId(options.kiosk));
}

Result<void> reload(store::Store& store, const KioskOptions& options) {
  STRATA_TRY(store.kiosks().ask_reload(KioskId(options.kiosk)));
  return {};
}

}  // namespace

Command add_kiosk(CLI::App& app) {
  auto* parent = app.add_subcommand("kiosk", "Manage the links of kiosks");
  auto options = std::make_shared<KioskOptions>();
  auto* made = add_subcommand(*parent, options, "create", "Create a link; it is printed only once");
  made->add_option("tour", options->tour, "MODEL/TOUR, by slug or id")->required();
  made->add_option("--name", options->name, "Name of the screen, for example its location")
      ->required();
  made->add_option("--days", options->days, "Days until the link expires (default: never)")
      ->check(CLI::Range(1, 3650));
  made->add_option("--url", options->url, "Address of the server, for the link")
      ->capture_default_str();
  add_subcommand(*parent, options, "list", "List all links, and when each screen was last seen");
  const auto add_of_one = [&](const char* name, const char* what) {
    add_subcommand(*parent, options, name, what)
        ->add_option("id", options->kiosk, "Id from `list`")
        ->required();
  };
  add_of_one("revoke", "Revoke a link");
  add_of_one("reload", "Reload the page of a screen");
  return choosing<KioskOptions>(
      parent, options,
      {{"create", create}, {"list", list}, {"revoke", revoke}, {"reload", reload}});
}

}  // namespace strata::cli
