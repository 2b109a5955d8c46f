#include <algorithm>
#include <map>
#include <set>

#include "core/text/filename.h"
#include "core/text/name_pattern.h"
#include "domain/people/role.h"
#include "domain/tables/attachment.h"
#include "domain/tables/column_value.h"
#include "domain/tables/table.h"
#include "net/api/addressed.h"
#include "net/api/route_help.h"
#include "net/api/routes.h"
#include "net/transport/server_options.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "store/tables/records.h"

namespace strata::net {
namespace {

constexpr const char* kKey = "key";

// Finds records by the value of a column in file names. Small differences in spelling are allowed.
class Values {
 public:
  void add(const std::string& value, std::int64_t key) {
    exact_[value].insert(key);
    loose_[loose_name(value)].insert(key);
  }
  // Returns the records that have this value. Returns one record if the value is unambiguous.
  std::set<std::int64_t> find(std::string_view text) const {
    if (const auto same = exact_.find(std::string(text)); same != exact_.end()) return same->second;
    const auto similar = loose_.find(loose_name(text));
    return similar == loose_.end() ? std::set<std::int64_t>() : similar->second;
  }

 private:
  std::map<std::string, std::set<std::int64_t>> exact_, loose_;
};

// The file names of each record, by key.
using Names = std::map<std::int64_t, std::set<std::string>>;

Result<Names> attached_names(const RouteContext& context, const Author& who, const Table& table,
                             const std::vector<Record>& records) {
  std::map<AttachmentId, std::vector<std::int64_t>> holders;
  std::vector<AttachmentId> ids;
  for (const Record& record : records)
    for (const Column& column : table.columns) {
      if (!holds_attachments(column.kind)) continue;
      const auto cell = record.values.find(column.id);
      if (cell == record.values.end()) continue;
      for (const auto& id : cell->second) {
        holders[id.get<AttachmentId>()].push_back(record.key);
        ids.push_back(id.get<AttachmentId>());
      }
    }
  auto found = STRATA_TRY(context.store.attachments().of_table(table.id, who, ids));
  Names names;
  for (const Attachment& attachment : found)
    for (const auto key : holders[attachment.id]) names[key].insert(attachment.name);
  return names;
}

Result<Response> match(const RouteContext& context, const Request& request) {
  auto body =
      STRATA_TRY(body_of<protocol::AttachmentMatch>(request, context.options.max_json_bytes));
  auto pattern = STRATA_TRY(NamePattern::parse(body.pattern, "pattern"));
  auto table = STRATA_TRY(stored_table(context, request));
  const Column* column = find_column(table.columns, body.column);
  if (!column && body.column != kKey)
    return fail(ErrorCode::invalid, "Column not found",
                table.name + " has no column `" + body.column + "`.", "column");
  const std::string word = column ? column->slug : kKey;
  if (!pattern.has(word))
    return fail(
        ErrorCode::invalid, "Column missing in pattern",
        "The pattern has no `{" + word + "}`. The server needs it to find the record of each file.",
        "pattern");
  store::RecordQuery query;
  query.limit = store::kMaxRecords;
  auto page = STRATA_TRY(context.store.records().page(table.id, request.role(), query));
  Values values;
  for (const Record& record : page.records) {
    if (!column) values.add(std::to_string(record.key), record.key);
    const auto cell = column ? record.values.find(column->id) : record.values.end();
    if (cell != record.values.end()) values.add(print_value(*column, cell->second), record.key);
  }
  auto names = STRATA_TRY(attached_names(context, request.author(), page.table, page.records));

  nlohmann::json matched = nlohmann::json::array(), unmatched = nlohmann::json::array(),
                 duplicate = nlohmann::json::array();
  std::set<std::pair<std::int64_t, std::string>> met;
  for (const std::string& sent : body.names) {
    const std::string name = base_filename(sent);
    const auto is_known = [&](std::string_view text) { return !values.find(text).empty(); };
    const auto reading = pattern.read(name, word, is_known);
    if (!reading || !reading->is_known) {
      unmatched.push_back({{"name", sent}, {"reason", reading ? "record" : "pattern"}});
      if (reading) unmatched.back()["words"] = reading->words;
      continue;
    }
    const auto keys = values.find(reading->words.at(word));
    if (keys.size() > 1) {
      unmatched.push_back({{"name", sent}, {"reason", "several"}, {"words", reading->words}});
      continue;
    }
    nlohmann::json entry{{"name", sent}, {"key", *keys.begin()}, {"words", reading->words}};
    const bool is_there = names[*keys.begin()].contains(name);
    if (met.emplace(*keys.begin(), name).second && !is_there) {
      matched.push_back(std::move(entry));
    } else {
      entry["reason"] = is_there ? "attached" : "twice";
      duplicate.push_back(std::move(entry));
    }
  }
  return json_response({{"matched", std::move(matched)},
                        {"unmatched", std::move(unmatched)},
                        {"duplicate", std::move(duplicate)},
                        {"total", body.names.size()}});
}

}  // namespace

void add_attachment_match_routes(Router& router, const RouteContext& context) {
  router.add(
      {.method = Method::post,
       .pattern = "/api/v1/tables/{table}/attachments/match",
       .handler = answering([&context](const Request& request) { return match(context, request); }),
       .body = BodyKind::memory,
       .max_body = context.options.max_json_bytes});
}

}  // namespace strata::net
