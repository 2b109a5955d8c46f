// `strata journal thin` removes old states from the history of models. It runs on the server's
// machine, even while the server is running.
#include <algorithm>
#include <iostream>
#include <thread>

#include "cli/progress_line.h"
#include "cli/subcommands.h"
#include "core/text/timestamp.h"
#include "core/version.h"
#include "store/journal/journal_merger.h"
#include "store/journal/journal_reads.h"
#include "store/journal/journal_thinner.h"

namespace strata::cli {
namespace {

using store::JournalThinner;
using Clock = std::chrono::steady_clock;
using Days = std::chrono::days;

constexpr std::chrono::milliseconds kShortestPause{1}, kLongestPause{2000};

struct JournalOptions {
  DataOptions data;
  std::string older_than, keep = "day", model;
  bool yes = false;
};

// For CLI11. Returns the problem of a text that is not an age.
std::string check_age(const std::string& text) {
  const auto age = store::parse_age(text);
  if (!age) return "Enter a number and a unit, at most 100 years: 90d, 26w, 18m or 2y.";
  if (*age >= JournalThinner::kMinAge) return {};
  return "Edits of the last " + std::to_string(JournalThinner::kMinAge.count()) +
         " days cannot be thinned.";
}

std::string megabytes(std::uint64_t bytes) {
  return std::to_string((bytes + (1 << 20) - 1) >> 20) + " MB";
}

std::int64_t print_plan(const std::vector<JournalThinner::ModelPlan>& plans,
                        const JournalThinner::Options& options) {
  std::int64_t removed = 0;
  std::uint64_t removed_bytes = 0;
  for (const auto& plan : plans) {
    std::cout << plan.name << " (" << to_string(plan.model) << "): " << plan.removed << " of "
              << plan.edits << " edits, about " << megabytes(plan.removed_bytes) << " of "
              << megabytes(plan.bytes) << "\n";
    removed += plan.removed;
    removed_bytes += plan.removed_bytes;
  }
  std::cout << "before " << day_of(options.before) << ", one state for each " << name(options.keep)
            << ": removes " << removed << " edits of " << plans.size()
            << (plans.size() == 1 ? " model" : " models") << ", about " << megabytes(removed_bytes)
            << std::endl;
  return removed;
}

// Waits until no older program can read the database.
Result<void> exclude_older_versions(JournalThinner& thinner, Progress& progress) {
  for (;;) {
    const bool may = STRATA_TRY(thinner.may_thin(version(), store::JournalMerger::kJoinsWithin));
    if (may) return {};
    progress.report(0, "waiting up to a minute for nodes that are starting");
    std::this_thread::sleep_for(std::chrono::seconds(1));
  }
}

// Painting must not become slower, so the thinner works at most half of the time.
class HalfTime {
 public:
  bool operator()() {
    std::this_thread::sleep_for(
        std::clamp<Clock::duration>(Clock::now() - begun_, kShortestPause, kLongestPause));
    begun_ = Clock::now();
    return true;
  }

 private:
  Clock::time_point begun_ = Clock::now();
};

Result<JournalThinner::Done> thin_all(JournalThinner& thinner,
                                      const std::vector<JournalThinner::ModelPlan>& plans,
                                      std::int64_t removed,
                                      const JournalThinner::Options& options) {
  Progress progress;
  const ProgressLine line(progress);
  STRATA_TRY(exclude_older_versions(thinner, progress));
  JournalThinner::Done all;
  std::int64_t before = 0;  // edits of the models before this one
  for (const auto& plan : plans) {
    progress.report(static_cast<double>(before) / static_cast<double>(removed), plan.name);
    STRATA_TRY(thinner.note(options, plan));
    const auto done = STRATA_TRY(thinner.thin(plan.model, options, HalfTime()));
    all.removed += done.removed;
    all.skipped += done.skipped;
    before += plan.removed;
  }
  return all;
}

Result<void> thin(store::Store& store, const JournalOptions& given) {
  JournalThinner::Options options;
  // A whole day, so that the plan and the work on the same day have the same limit.
  options.before = std::chrono::floor<Days>(std::chrono::system_clock::now()) -
                   *store::parse_age(given.older_than);
  options.keep = *store::parse_period(given.keep);
  JournalThinner thinner(store.journal());
  const auto plans = STRATA_TRY(thinner.plan(options, given.model));
  const std::int64_t removed = print_plan(plans, options);
  if (!given.yes) {
    if (removed > 0)
      std::cout << "Nothing has changed. Make a backup, and add --yes to remove these edits. They "
                   "cannot be restored."
                << std::endl;
    return {};
  }
  JournalThinner::Done done;
  if (removed > 0) done = STRATA_TRY(thin_all(thinner, plans, removed, options));
  STRATA_TRY(thinner.forget_answers(given.model, HalfTime()));
  std::cout << "removed " << done.removed << " edits" << std::endl;
  if (done.skipped == 0) return {};
  return fail(ErrorCode::conflict, "History is not completely thinned",
              std::to_string(done.skipped) +
                  " parts of the history did not change, because somebody changed them at the same "
                  "time or because they are damaged. The warnings above name them. Run the command "
                  "again.");
}

}  // namespace

Command add_journal(CLI::App& app) {
  auto* parent = app.add_subcommand("journal", "Manage the history of models");
  auto options = std::make_shared<JournalOptions>();
  // Servers of an older version would return wrong states. The database shows that the server has
  // this version.
  options->data.migrates = false;
  auto* command = add_subcommand(
      *parent, options, "thin",
      "Remove old states from the history. Without --yes, only print what would be removed");
  command
      ->add_option("--older-than", options->older_than,
                   "Only edits older than this: 90d, 26w, 18m or 2y")
      ->check(check_age)
      ->required();
  command->add_option("--keep", options->keep, "Keep the state at the end of each of these periods")
      ->check(CLI::IsMember({"day", "week", "month", "year"}))
      ->capture_default_str();
  command->add_option("--model", options->model, "Only this model (id or slug)");
  command->add_flag("--yes", options->yes, "Remove the states");
  std::map<std::string, Work<JournalOptions>> works;
  works["thin"] = thin;
  return choosing<JournalOptions>(parent, options, std::move(works));
}

}  // namespace strata::cli
