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

// Returns the highlighted keys, ascending. Returns an `invalid` error at `field` for a condition
// that does not match the columns.
Result<std::vector<std::uint32_t>> highlighted_keys(store::Store& store, TableId table_id,
                                                    Role seen_by, const Highlight& highlight,
                                                    const std::string& field);

// Palettes by key for the database layers of an open model. They are needed if the colors of a
// layer depend on its records: colors by a column, and highlighted records. A worker makes a
// palette when a view first needs it, and again when records change. Thread-safe.
class RecordColors : public std::enable_shared_from_this<RecordColors> {
 public:
  // `ready` is called, on any thread, when a requested palette is ready or has failed.
  RecordColors(store::Store& store, boost::asio::thread_pool& workers, std::function<void()> ready);

  // Requests are compared by the addresses of their objects, so the objects must not change.
  struct Request {
    TableId table = 0;
    // The most restricted visibility of the columns that may be read.
    Visibility sight = Visibility::everyone;
    std::shared_ptr<const Palette> palette;
    std::shared_ptr<const Highlight> highlight;  // null: no highlight
  };
  struct Found {
    std::shared_ptr<const Palette> palette;  // null if it is not ready yet or has failed
    std::shared_ptr<const Error> problem;    // the reason of a failure
  };
  // Returns the newest palette that is ready. Starts to make a missing or outdated palette.
  Found find(const Request& request);
  // Makes the current palette on the calling thread. Blocks.
  Result<std::shared_ptr<const Palette>> make(const Request& request) const {
    return make(store_, request);
  }
  static Result<std::shared_ptr<const Palette>> make(store::Store& store, const Request& request);
  // Returns false if the drawing depends only on the palette.
  static bool needs_records(const Palette& palette,
                            const std::shared_ptr<const Highlight>& highlight) {
    return highlight || !palette.column.empty();
  }

  void records_changed(TableId table_id);
  void make_again();  // makes all palettes again, because the database was unreachable
  void stop();        // stops making palettes, and no longer calls `ready`

 private:
  struct Entry {
    Request request;
    Found found;
    bool making = false;
    bool outdated = true;  // records have changed since the last start
  };
  void start(const std::shared_ptr<Entry>& entry);  // call while holding the mutex
  void run(const std::shared_ptr<Entry>& entry);

  store::Store& store_;
  boost::asio::thread_pool& workers_;
  const std::function<void()> ready_;
  std::mutex mutex_;
  std::vector<std::shared_ptr<Entry>> entries_;
  bool stopped_ = false;
};

}  // namespace strata::room
