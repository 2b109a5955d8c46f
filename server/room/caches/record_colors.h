#pragma once

#include <boost/asio/thread_pool.hpp>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "core/ids.h"
#include "domain/layers/palette.h"
#include "domain/people/role.h"
#include "domain/people/visibility.h"
#include "room/view_settings.h"
#include "store/store.h"

namespace strata::room {

// Returns the highlighted keys, ascending. Refused (invalid at `field`): a condition that does not
// fit the columns.
Result<std::vector<std::uint32_t>> highlighted_keys(store::Store& store, TableId table_id,
                                                    Role seen_by, const Highlight& highlight,
                                                    const std::string& field);

// Palettes by key of an open model's database layers, for layers whose drawing depends on their
// records: colors by a column, and highlighted records. A worker makes them when a view first needs
// them, and again when records change. Thread-safe.
class RecordColors : public std::enable_shared_from_this<RecordColors> {
 public:
  // `ready` is called, on any thread, whenever a requested palette is made or has failed.
  RecordColors(store::Store& store, boost::asio::thread_pool& workers, std::function<void()> ready);

  // Requests are compared by the addresses of their objects, which must not change.
  struct Request {
    TableId table = 0;
    Visibility sight = Visibility::everyone;  // the most restricted visibility of the columns that
                                              // may be read
    std::shared_ptr<const Palette> palette;
    std::shared_ptr<const Highlight> highlight;  // null: no highlight
  };
  struct Found {
    std::shared_ptr<const Palette> palette;  // null: not made yet, or failed
    std::shared_ptr<const Error> problem;    // reason of the failure
  };
  // Returns the newest palette that is ready; starts making a missing or outdated one.
  Found find(const Request& request);
  // Makes the present palette on the calling thread. Blocks.
  Result<std::shared_ptr<const Palette>> make(const Request& request) const {
    return make(store_, request);
  }
  static Result<std::shared_ptr<const Palette>> make(store::Store& store, const Request& request);
  // Returns false if the palette itself is sufficient.
  static bool needs_records(const Palette& palette,
                            const std::shared_ptr<const Highlight>& highlight) {
    return highlight || !palette.column.empty();
  }

  void records_changed(TableId table_id);
  void stop();  // makes nothing more, and does not call `ready`

 private:
  struct Entry {
    Request request;
    Found found;
    bool making = false;
    bool outdated = true;  // records changed since the last start
  };
  void start(const std::shared_ptr<Entry>& entry);  // with the mutex held
  void run(const std::shared_ptr<Entry>& entry);

  store::Store& store_;
  boost::asio::thread_pool& workers_;
  const std::function<void()> ready_;
  std::mutex mutex_;
  std::vector<std::shared_ptr<Entry>> entries_;
  bool stopped_ = false;
};

}  // namespace strata::room
