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

// The keys that are meant, ascending. Refused (invalid at `field`): what the columns do not fit.
Result<std::vector<std::uint32_t>> highlighted_keys(store::Store& store, TableId table_id,
                                                    Role seen_by, const Highlight& highlight,
                                                    const std::string& field);

// Palettes by key of an open model's database layers, where what a layer is drawn with depends on
// its records: colours by a column, and records that are to be seen before all others. They are
// made on a worker when a view first needs them, and anew when records change. Thread-safe.
class RecordColors : public std::enable_shared_from_this<RecordColors> {
 public:
  // `ready` is called, on any thread, whenever something that was asked for is there or has failed.
  RecordColors(store::Store& store, boost::asio::thread_pool& workers, std::function<void()> ready);

  // What is asked for, told apart by the objects: nothing of it may change.
  struct Wanted {
    TableId table = 0;
    Visibility sight = Visibility::everyone;  // the least seen of the columns that may be read
    std::shared_ptr<const Palette> palette;
    std::shared_ptr<const Highlight> highlight;  // null: none
  };
  struct Found {
    std::shared_ptr<const Palette> palette;  // null: not there yet, or not to be had
    std::shared_ptr<const Error> problem;    // why not
  };
  // The newest that is there; what is not is on its way.
  Found find(const Wanted& wanted);
  // The same as of now, made on the calling thread. Blocks.
  Result<std::shared_ptr<const Palette>> make(const Wanted& wanted) const {
    return make(store_, wanted);
  }
  static Result<std::shared_ptr<const Palette>> make(store::Store& store, const Wanted& wanted);
  // Whether there is anything to be made of it: otherwise the palette itself serves.
  static bool needs_records(const Palette& palette,
                            const std::shared_ptr<const Highlight>& highlight) {
    return highlight || !palette.column.empty();
  }

  void records_changed(TableId table_id);
  void stop();  // nothing more is made, and `ready` not called

 private:
  struct Entry {
    Wanted wanted;
    Found found;
    bool making = false;
    bool outdated = true;  // by records that changed since the last making began
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
