#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/ids.h"
#include "store/journal/thin_plan.h"

namespace strata::store {

class Journal;

// Thins the old part of journals, if an administrator asks for it: consecutive edits of a layer
// become one checkpoint for each period (thin_plan.h). Unlike a merge, this removes states and the
// undo of old edits. These stay exact:
// - the newest state, the states at the end of each period, and the states that people have named
// - undo, redo and reviews of edits that are not in a checkpoint
// - edits that wait for review, and edits that an undo or review after `before` has changed
// - the responses to ids, for `kAnswersFor`
//
// Each checkpoint is one transaction that replaces rows. Before that, it is checked that the new
// rows have the same effect as the old ones. The transaction replaces the revisions first. Then it
// locks the rows of the model and the layer in the order of the journal writer, and ends soon. It
// changes nothing if somebody has changed the rows since they were read. It needs no claim of the
// model: no room keeps old states that it writes, and the writer refuses an undo of edits that are
// in a checkpoint now. The work can be interrupted at any time, and continues with the remaining
// edits when it is started again. Damaged rows do not change, and the log names them. Used by one
// thread at a time; several objects can work at once.
class JournalThinner {
 public:
  // A browser may send a change again that it could not confirm before it was closed.
  static constexpr std::chrono::days kAnswersFor{365};
  // Younger edits are never thinned: `plan` and `thin` return `invalid`.
  static constexpr std::chrono::days kMinAge{30};

  struct Options {
    std::chrono::system_clock::time_point before;  // only edits before this time
    Period keep = Period::day;
  };
  struct ModelPlan {
    ModelId model = 0;
    std::string name;
    std::int64_t edits = 0;    // before `before`
    std::int64_t removed = 0;  // of these
    // Approximate bytes of the journal of the model, and those that the removed edits need.
    std::uint64_t bytes = 0, removed_bytes = 0;
  };
  struct Done {
    std::int64_t removed = 0;  // edits
    std::int64_t skipped = 0;  // groups of edits that did not change; the log contains the reason
  };
  // Called between transactions. It may wait. If it returns false, the thinner stops.
  using Continue = std::function<bool()>;

  explicit JournalThinner(Journal& journal, std::size_t edits_at_once = 20'000)
      : journal_(journal), edits_at_once_(edits_at_once) {}

  // Returns whether the journals may be thinned, as JournalMerger::may_merge. Returns `conflict` if
  // the site has a node of another version.
  Result<bool> may_thin(std::string_view version, std::chrono::milliseconds after_mark);

  // Returns the plan of a model, or of all models if `ref` is empty, without models that do not
  // change. `ref` is an id or a slug. Models and layers in the Trash are not included.
  Result<std::vector<ModelPlan>> plan(const Options& options, const std::string& ref = {});
  // Writes the beginning of the work on a model to the audit log.
  Result<void> note(const Options& options, const ModelPlan& plan);
  Result<Done> thin(ModelId model, const Options& options, const Continue& go_on);
  // Deletes the responses that were kept when younger edits were thinned. `ref` as for `plan`.
  Result<void> forget_answers(const std::string& ref, const Continue& go_on);

 private:
  struct Window {
    std::vector<OldEdit> edits;
    ThinRules rules;
    bool is_cut = false;  // there are more edits after these
  };
  Result<void> check_limit(const Options& options);
  Result<std::int64_t> last_before(ModelId model, std::chrono::system_clock::time_point before);
  Result<Window> read_window(ModelId model, std::int64_t after, std::int64_t through,
                             const Options& options);
  // Returns the number of edits that the journal no longer has.
  Result<std::int64_t> thin_group(ModelId model, LayerId layer, std::int64_t through,
                                  const std::vector<std::int64_t>& sequences);

  Journal& journal_;
  const std::size_t edits_at_once_;
};

}  // namespace strata::store
