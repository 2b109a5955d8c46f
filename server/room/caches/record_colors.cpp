#include "room/caches/record_colors.h"

#include <algorithm>
#include <boost/asio/post.hpp>

#include "domain/layers/key_colors.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"

namespace strata::room {
namespace {

Expression column_of(const std::string& slug) {
  Expression column;
  column.op = Expression::Op::column;
  column.path = {slug};
  return column;
}

bool holds_numbers(ColumnKind kind) {
  return kind == ColumnKind::integer || kind == ColumnKind::numeric;
}

Result<Palette> by_column(store::Store& store, TableId table_id, Role seen_by,
                          const Palette& palette) {
  auto table = STRATA_TRY(store.tables().find(to_string(table_id), seen_by));
  const Column* column = find_column(table.columns, palette.column);
  if (!column)
    return fail(ErrorCode::invalid, "Column not found",
                "The palette takes its colors from the column '" + palette.column +
                    "', which the table '" + table.name + "' no longer has. Choose another column.",
                "palette.column");
  if (holds_numbers(column->kind)) {
    auto numbers = store.records().numbers(table_id, seen_by, column_of(column->slug), std::nullopt,
                                           "palette.column");
    if (!numbers) return tl::unexpected(numbers.error());
    return colors_of_numbers(palette, *numbers);
  }
  if (palette.mode != PaletteMode::categorical)
    return fail(
        ErrorCode::invalid, "Column without numbers",
        "'" + column->name + "' contains no numbers. Only a categorical palette can use it.",
        "palette.column");
  auto texts = store.records().texts(table_id, seen_by, column->slug, "palette.column");
  if (!texts) return tl::unexpected(texts.error());
  return colors_of_texts(palette, *texts);
}

}  // namespace

Result<std::vector<std::uint32_t>> highlighted_keys(store::Store& store, TableId table_id,
                                                    Role seen_by, const Highlight& highlight,
                                                    const std::string& field) {
  if (const auto* keys = std::get_if<std::vector<std::uint32_t>>(&highlight.records)) return *keys;
  auto truths = STRATA_TRY(store.records().numbers(
      table_id, seen_by, std::get<Expression>(highlight.records), std::nullopt, field));
  std::vector<std::uint32_t> keys;
  for (const KeyNumber& truth : truths)
    if (truth.number != 0) keys.push_back(truth.key);
  std::ranges::sort(keys);
  return keys;
}

RecordColors::RecordColors(store::Store& store, boost::asio::thread_pool& workers,
                           std::function<void()> ready)
    : store_(store), workers_(workers), ready_(std::move(ready)) {}

Result<std::shared_ptr<const Palette>> RecordColors::make(store::Store& store,
                                                          const Request& request) {
  Palette by_key = *request.palette;
  const Role seen_by = least_role(request.sight);
  if (!by_key.column.empty()) {
    auto colored = STRATA_TRY(by_column(store, request.table, seen_by, by_key));
    by_key = std::move(colored);
  }
  if (request.highlight) {
    const auto keys =
        highlighted_keys(store, request.table, seen_by, *request.highlight, "highlight.filter");
    if (!keys) return tl::unexpected(keys.error());
    by_key = highlighted_colors(by_key, *keys, request.highlight->isolate);
  }
  return std::make_shared<const Palette>(std::move(by_key));
}

RecordColors::Found RecordColors::find(const Request& request) {
  std::lock_guard lock(mutex_);
  // Drops the entries whose palette or highlight only this cache refers to. No view requests these
  // entries.
  std::erase_if(entries_, [](const auto& entry) {
    const Request& cached = entry->request;
    return !entry->making && (cached.palette.use_count() == 1 ||
                              (cached.highlight && cached.highlight.use_count() == 1));
  });
  const auto known = std::ranges::find_if(entries_, [&](const auto& entry) {
    const Request& cached = entry->request;
    return cached.table == request.table && cached.sight == request.sight &&
           cached.palette == request.palette && cached.highlight == request.highlight;
  });
  const auto entry = known != entries_.end()
                         ? *known
                         : entries_.emplace_back(std::make_shared<Entry>(Entry{request, {}}));
  start(entry);
  return entry->found;
}

void RecordColors::start(const std::shared_ptr<Entry>& entry) {
  if (stopped_ || entry->making || !entry->outdated) return;
  entry->making = true;
  entry->outdated = false;
  boost::asio::post(workers_, [self = shared_from_this(), entry] { self->run(entry); });
}

void RecordColors::run(const std::shared_ptr<Entry>& entry) {
  auto made = make(entry->request);
  {
    std::lock_guard lock(mutex_);
    if (stopped_) return;
    entry->making = false;
    if (made)
      entry->found = {std::move(*made), nullptr};
    else
      entry->found.problem = std::make_shared<const Error>(made.error());
    start(entry);
  }
  if (ready_) ready_();
}

void RecordColors::records_changed(TableId table_id) {
  std::lock_guard lock(mutex_);
  for (const auto& entry : entries_) {
    if (entry->request.table != table_id) continue;
    entry->outdated = true;
    start(entry);
  }
}

void RecordColors::make_again() {
  std::lock_guard lock(mutex_);
  for (const auto& entry : entries_) {
    entry->outdated = true;
    start(entry);
  }
}

void RecordColors::stop() {
  std::lock_guard lock(mutex_);
  stopped_ = true;
}

}  // namespace strata::room
