#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "app/deposit/crate_json.h"
#include "app/deposit/deposit_parts.h"
#include "app/records/record_csv.h"
#include "core/text/csv.h"
#include "core/text/timestamp.h"
#include "domain/tables/attachment.h"
#include "domain/tables/term_list.h"
#include "store/store.h"
#include "store/tables/attachments.h"
#include "store/tables/records.h"
#include "store/tables/tables.h"
#include "vocabulary/terms_skos.h"

namespace strata::app {
namespace {

using nlohmann::json;

constexpr const char* kCsv = "text/csv";
constexpr std::int64_t kPage = 5000;
constexpr std::size_t kRecordsPerFile = 50'000;  // read_records_csv reads a whole file
constexpr int kHistoryPage = 1000;

// The data type of CSV on the Web.
const char* datatype_of(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::integer:
    case ColumnKind::term: return "integer";
    case ColumnKind::numeric: return "double";
    case ColumnKind::boolean: return "boolean";
    case ColumnKind::date: return "date";
    case ColumnKind::timestamp: return "dateTimeStamp";
    case ColumnKind::url: return "anyURI";
    default: return "string";
  }
}

// Adds the files of one table.
class TableDeposit {
 public:
  TableDeposit(Bag& bag, const DepositReader& from, const Table& table)
      : bag_(bag), from_(from), store_(from.services.store), table_(table) {
    base_ = "tables/" + table.slug;
  }

  Result<json> add() {
    all_ = crate::to_crate(table_);
    from_.progress.report(0, "Reading the table " + table_.name);
    STRATA_TRY(add_records());
    STRATA_TRY(add_schema());
    STRATA_TRY(add_terms());
    STRATA_TRY(add_history());
    STRATA_TRY(add_attachments());
    return std::move(all_);
  }

 private:
  BagFile file(const std::string& path, std::string media_type, std::string description) const {
    BagFile added;
    added.path = bag_.free_path(path);
    added.media_type = std::move(media_type);
    added.description = std::move(description);
    return added;
  }

  Result<void> add_records() {
    const auto columns = term_columns(table_);
    store::RecordQuery query;
    query.limit = kPage;
    std::vector<Record> part;
    const auto end_part = [&]() -> Result<void> {
      const std::string number =
          files_.empty() ? std::string() : "-" + std::to_string(files_.size() + 1);
      BagFile added = file(base_ + number + ".csv", kCsv, "Records of the table " + table_.name);
      files_.push_back(added.path);
      STRATA_TRY(bag_.add(std::move(added), records_csv(part, table_.columns, {}, ',')));
      part.clear();
      return {};
    };
    for (bool goes_on = true; goes_on;) {
      if (from_.progress.cancelled()) return cancelled_problem();
      auto page = STRATA_TRY(store_.records().page(table_.id, from_.reader.role, query));
      goes_on = page.last.has_value();
      query.after = page.last;
      for (Record& record : page.records) {
        note_attachments(record);
        if (columns) terms_.push_back(record);
        part.push_back(std::move(record));
      }
      if (part.size() >= kRecordsPerFile || (!goes_on && (!part.empty() || files_.empty())))
        STRATA_TRY(end_part());
    }
    all_["files"] = files_;
    return {};
  }

  void note_attachments(const Record& record) {
    for (const Column& column : table_.columns) {
      if (!holds_attachments(column.kind)) continue;
      const auto value = record.values.find(column.id);
      if (value == record.values.end() || value->second.is_null()) continue;
      for (const json& id : value->second) attachments_.insert(id.get<AttachmentId>());
    }
  }

  Result<void> add_schema() {
    json columns = json::array(
        {{{"name", "key"}, {"titles", "key"}, {"datatype", "integer"}, {"required", true}}});
    for (const Column& column : table_.columns) {
      json shown{{"name", column.slug},
                 {"titles", column.slug},
                 {"datatype", datatype_of(column.kind)},
                 {"required", column.required},
                 {"dc:title", column.name}};
      if (!column.comment.empty()) shown["dc:description"] = column.comment;
      columns.push_back(std::move(shown));
    }
    json tables = json::array();
    for (const std::string& path : files_)
      tables.push_back({{"url", path.substr(path.rfind('/') + 1)},
                        {"dc:title", table_.name},
                        {"dc:description", table_.description},
                        {"tableSchema", {{"columns", columns}, {"primaryKey", "key"}}}});
    const json group{{"@context", "http://www.w3.org/ns/csvw"}, {"tables", std::move(tables)}};
    return bag_.add(file(base_ + ".csv-metadata.json", "application/csvm+json",
                         "Columns of the table " + table_.name + " (CSV on the Web)"),
                    group.dump(1));
  }

  Result<void> add_terms() {
    const auto columns = term_columns(table_);
    if (!columns) return {};
    const auto listed = list_terms(*columns, terms_);
    std::vector<Term> terms;
    for (const ListedTerm& each : listed) terms.push_back(each.term);
    const auto text = STRATA_TRY(terms_skos(table_.name, terms));
    BagFile added = file(base_ + ".ttl", "text/turtle", "Terms of " + table_.name + " (SKOS)");
    all_["skos"] = added.path;
    return bag_.add(std::move(added), text);
  }

  Result<void> add_history() {
    std::string text =
        csv_line({"sequence", "time", "person", "operation", "in_force", "change"}, ',');
    std::optional<std::int64_t> before;
    for (;;) {
      const auto page = STRATA_TRY(store_.tables().history(table_.id, from_.reader.role,
                                                           std::nullopt, kHistoryPage, 0, before));
      for (const store::TableEditRow& row : page.rows) {
        text += csv_line({std::to_string(row.sequence), utc_text(row.time), guard_formula(row.user),
                          row.op, row.in_force ? "true" : "false", row.record.dump()},
                         ',');
        before = row.sequence;
      }
      if (page.rows.size() < kHistoryPage) break;
    }
    BagFile added = file(base_ + "-history.csv", kCsv, "History of the table " + table_.name);
    all_["history"] = added.path;
    return bag_.add(std::move(added), text);
  }

  Result<void> add_attachments() {
    all_["attachments"] = json::array();
    const std::vector<AttachmentId> ids(attachments_.begin(), attachments_.end());
    const auto attachments =
        STRATA_TRY(store_.attachments().of_table(table_.id, from_.reader, ids));
    for (const Attachment& attachment : attachments) {
      BagFile added =
          file("attachments/" + table_.slug + "/" + portable_name(attachment.name, "file"),
               attachment.media_type, "File of the table " + table_.name);
      added.sha256 = attachment.sha256;
      added.bytes = attachment.bytes;
      all_["attachments"].push_back(
          {{"id", attachment.id},
           {"name", attachment.name},
           {"media_type", attachment.media_type},
           {"width", attachment.width ? json(*attachment.width) : json()},
           {"height", attachment.height ? json(*attachment.height) : json()},
           {"visibility", name(attachment.visibility)},
           {"user", attachment.user},
           {"time", utc_text(attachment.time)},
           {"file", added.path}});
      bag_.add_stored(std::move(added));
    }
    return {};
  }

  Bag& bag_;
  const DepositReader& from_;
  store::Store& store_;
  const Table& table_;
  std::string base_;
  std::vector<std::string> files_;
  std::vector<Record> terms_;  // of a term list
  std::set<AttachmentId> attachments_;
  json all_;
};

}  // namespace

Result<json> add_table(Bag& bag, const DepositReader& from, const Table& table) {
  return TableDeposit(bag, from, table).add();
}

}  // namespace strata::app
