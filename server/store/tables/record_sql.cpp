#include "store/tables/record_sql.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "core/text/closest.h"
#include "core/text/edtf.h"
#include "core/text/timestamp.h"
#include "expression/expression_parser.h"
#include "expression/operators.h"
#include "store/tables/table_writer.h"

namespace strata::store {
namespace {

using Op = Expression::Op;

// Days that are stored as doubles are exact to a millisecond for about 100 000 years.
constexpr const char* kToEndOfDay = "0.99999999";

enum class Kind { number, truth, text, time, keys, features };

const char* in_words(Kind kind) {
  switch (kind) {
    case Kind::number: return "numbers";
    case Kind::truth: return "true or false";
    case Kind::text: return "texts";
    case Kind::time: return "times";
    case Kind::features: return "lines or points";
    default: return "keys of records";
  }
}

Kind kind_of(const Column& column) {
  switch (column.kind) {
    case ColumnKind::integer:
    case ColumnKind::numeric:
    case ColumnKind::term: return Kind::number;
    case ColumnKind::boolean: return Kind::truth;
    case ColumnKind::date:
    case ColumnKind::timestamp:
    case ColumnKind::period: return Kind::time;
    case ColumnKind::relation:
    case ColumnKind::picture:
    case ColumnKind::document: return Kind::keys;
    case ColumnKind::line:
    case ColumnKind::point: return Kind::features;
    default: return Kind::text;
  }
}

// A part of a statement. For a time, `text` is its first moment in days since 1970, and `end` is
// its last moment.
struct Sql {
  Kind kind = Kind::number;
  std::string text, end;
  const Column* column = nullptr;  // set if the part is only a column
};

std::string replaced(std::string text, std::string_view what, const std::string& by) {
  for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + by.size()))
    text.replace(at, what.size(), by);
  return text;
}

// Returns the SQL of an operator with its operands. Operands contain no braces, because texts and
// numbers are parameters and columns are named by number. Each operand is computed only once, even
// if the operator uses it several times.
std::string of_operands(std::string_view sql, const std::string& a, const std::string& b = {}) {
  const auto is_once = [&](std::string_view name) { return sql.find(name) == sql.rfind(name); };
  if (is_once("{a}") && is_once("{b}"))
    return replaced(replaced(std::string(sql), "{a}", a), "{b}", b);
  return "(SELECT " + replaced(replaced(std::string(sql), "{a}", "a"), "{b}", "b") +
         " FROM (SELECT " + a + " AS a" + (b.empty() ? "" : ", " + b + " AS b") + ") q)";
}

std::string of_times(const char* sql, const Sql& a, const Sql& b) {
  std::string done = replaced(sql, "{a_end}", a.end);
  done = replaced(std::move(done), "{b_end}", b.end);
  done = replaced(std::move(done), "{a}", a.text);
  return replaced(std::move(done), "{b}", b.text);
}

class Writer {
 public:
  Writer(const OpenTable& open, PgConnection& connection, Params& params, const std::string& field)
      : table_(open.table),
        seen_by_(open.seen_by),
        connection_(connection),
        params_(params),
        field_(field) {}

  Result<std::string> write(const Expression& expression, Kind expected) {
    const std::string sql = expected == Kind::truth ? condition(expression) : number(expression);
    if (problem_) return tl::unexpected(*problem_);
    return sql;
  }

 private:
  // Keeps the first error. SQL that is written after an error is never used.
  Sql refuse(const std::string& what, const Expression& at,
             std::string_view reason = mistake::kWrongType,
             std::vector<std::string> suggestions = {}) {
    if (!problem_)
      problem_ = expression_problem(what, at.position, field_, reason, std::move(suggestions));
    return {};
  }

  std::string parameter() const { return "$" + std::to_string(params_.count()); }
  std::string parameter(double number) {
    params_.real(number);
    return parameter();
  }
  std::string parameter(const std::string& text) {
    params_.text(text);
    return parameter();
  }

  // --- columns

  static std::string name_of(const Column& column) { return "c" + to_string(column.id); }

  const Table* target_of(const Column& column) {
    const auto [found, is_new] = targets_.try_emplace(*column.target);
    if (is_new) {
      auto open = read_table(connection_, *column.target, seen_by_);
      if (!open) {
        if (!problem_) problem_ = open.error();
        return nullptr;
      }
      found->second = std::move(open->table);
    }
    return &found->second;
  }

  static std::string some_columns(const Table& table) {
    std::string names = "key";
    for (const Column& column : table.columns)
      if (names.size() < 300) names += ", " + column.slug;
    return names;
  }

  Sql column(const Expression& e) {
    // Returns the SQL for a column of the current row. `name` is its name in the database.
    std::function<std::string(const std::string&)> reach = [](const std::string& name) {
      return "t." + name;
    };
    const Table* table = &table_;
    for (std::size_t step = 0; step + 1 < e.path.size(); ++step) {
      const Column* column = find_column(table->columns, e.path[step]);
      if (column == nullptr) return no_column(*table, e, step);
      if (column->kind != ColumnKind::term)
        return refuse("'" + column->slug + "' does not contain a key of another table", e);
      const Table* target = target_of(*column);
      if (target == nullptr) return {};
      const std::string alias = "u" + std::to_string(++aliases_), key = reach(name_of(*column));
      reach = [alias, key, id = target->id](const std::string& name) {
        return "(SELECT " + alias + "." + name + " FROM records.t" + to_string(id) + " " + alias +
               " WHERE " + alias + ".key = " + key + ")";
      };
      table = target;
    }
    if (e.path.back() == "key") return {Kind::number, reach("key") + "::float8", {}, nullptr};
    const Column* column = find_column(table->columns, e.path.back());
    if (column == nullptr) return no_column(*table, e, e.path.size() - 1);
    return value_of(*column, reach);
  }

  Sql no_column(const Table& table, const Expression& e, std::size_t step) {
    return refuse(table.name.substr(0, 100) + " has no column '" + e.path[step].substr(0, 100) +
                      "'. It has " + some_columns(table),
                  e, mistake::kUnknownColumn, corrected(table, e, step));
  }

  // Returns one path for each column with a similar slug or name. In the path, the slug of the
  // column replaces the part at the step.
  static std::vector<std::string> corrected(const Table& table, const Expression& e,
                                            std::size_t step) {
    std::vector<std::string> names{"key"};
    std::map<std::string, std::string> slug_of;
    for (const Column& column : table.columns) {
      names.push_back(column.slug);
      if (slug_of.emplace(column.name, column.slug).second) names.push_back(column.name);
    }
    std::vector<std::string> paths;
    for (const std::string& found : closest_names(e.path[step], names)) {
      const auto named = slug_of.find(found);
      std::string path;
      for (std::size_t i = 0; i < e.path.size(); ++i)
        path += (i == 0 ? "" : ".") + query::name_in_expression(i != step ? e.path[i]
                                                                : named == slug_of.end()
                                                                    ? found
                                                                    : named->second);
      if (std::ranges::find(paths, path) == paths.end()) paths.push_back(std::move(path));
    }
    return paths;
  }

  static Sql value_of(const Column& column,
                      const std::function<std::string(const std::string&)>& reach) {
    const std::string value = reach(name_of(column));
    Sql sql{kind_of(column), value, {}, &column};
    switch (column.kind) {
      case ColumnKind::integer:
      case ColumnKind::term: sql.text += "::float8"; break;
      case ColumnKind::date:
        sql.text = "(" + value + " - date '1970-01-01')::float8";
        sql.end = "(" + sql.text + " + " + kToEndOfDay + ")";
        break;
      case ColumnKind::timestamp:
        sql.text = "(extract(epoch from " + value + ")::float8 / 86400)";
        sql.end = sql.text;
        break;
      case ColumnKind::period: {
        const auto bound = [&](const std::string& which, const char* open) {
          return "(CASE WHEN " + value + " IS NOT NULL THEN coalesce(" +
                 reach(name_of(column) + which) + "::float8, '" + open + "') END)";
        };
        sql.text = bound("_first", "-Infinity");
        sql.end = "(" + bound("_last", "Infinity") + " + " + kToEndOfDay + ")";
        break;
      }
      default: break;
    }
    return sql;
  }

  // --- texts and times

  std::string fold(const Expression& e) {
    return of_operands(find_operator(e.op)->sql, text(e.parts[0]));
  }

  std::string text(const Expression& e) {
    if (e.op == Op::text) return parameter(e.text);
    if (e.is_text()) return fold(e);
    const Sql sql = operand(e);
    if (sql.kind != Kind::text) refuse(wrong(e, sql, Kind::text), e);
    return sql.text;
  }

  static std::string wrong(const Expression& e, const Sql& sql, Kind expected) {
    const std::string what =
        e.is_column() ? "'" + e.path.back().substr(0, 100) + "' holds " : "These are ";
    std::string advice;
    if (sql.column && sql.column->kind == ColumnKind::term && expected == Kind::text)
      advice = "; name a column of the record behind the key, as in " + sql.column->slug + ".code";
    return what + in_words(sql.kind) + ", not " + in_words(expected) + advice;
  }

  Sql time(const Expression& e) {
    if (e.op == Op::text) return time_of_text(e);
    Sql sql = operand(e);
    if (sql.kind != Kind::time) return refuse(wrong(e, sql, Kind::time), e);
    return sql;
  }

  Sql time_of_text(const Expression& e) {
    Sql sql{Kind::time, {}, {}, nullptr};
    if (const auto period = parse_edtf(e.text)) {
      constexpr double kOpen = std::numeric_limits<double>::infinity();
      sql.text = parameter(period->first_day ? static_cast<double>(*period->first_day) : -kOpen);
      sql.end = "(" + parameter(period->last_day ? static_cast<double>(*period->last_day) : kOpen) +
                "::float8 + " + kToEndOfDay + ")";
      return sql;
    }
    const auto moment = utc_timestamp(e.text);
    if (!moment)
      return refuse("'" + e.text.substr(0, 100) + "' is not a date; write dates as 2024-05-02", e);
    sql.text = "(extract(epoch from " + parameter(*moment) + "::timestamptz)::float8 / 86400)";
    sql.end = sql.text;
    return sql;
  }

  // --- numbers

  std::string number(const Expression& e) {
    switch (e.op) {
      case Op::number:
        return std::isfinite(e.number) ? parameter(e.number) + "::float8" : "NULL::float8";
      case Op::column: {
        const Sql sql = column(e);
        if (sql.kind != Kind::number) refuse(wrong(e, sql, Kind::number), e);
        return sql.text;
      }
      case Op::choose: {
        const std::string when = condition(e.parts[0]), then = number(e.parts[1]),
                          otherwise = number(e.parts[2]);
        return "(SELECT CASE WHEN a THEN " + then + " WHEN NOT a THEN " + otherwise +
               " END FROM (SELECT " + when + " AS a) q)";
      }
      case Op::layer: refuse("'" + e.name.substr(0, 100) + "' is not a column", e); return {};
      default: return computed(e);
    }
  }

  std::string computed(const Expression& e) {
    const Operator* row = find_operator(e.op);
    if (!row || !row->apply) {
      refuse("Expected a number here", e);
      return {};
    }
    std::string all = number(e.parts[0]);
    if (e.parts.size() == 1) return of_operands(row->sql, all);
    for (std::size_t part = 1; part < e.parts.size(); ++part)
      all = of_operands(row->sql, all, number(e.parts[part]));
    return all;
  }

  // --- conditions

  Sql operand(const Expression& e) {
    if (e.is_column()) return column(e);
    if (e.op == Op::text) return {Kind::text, parameter(e.text), {}, nullptr};
    if (e.is_text()) return {Kind::text, fold(e), {}, nullptr};
    if (e.is_condition()) return {Kind::truth, condition(e), {}, nullptr};
    return {Kind::number, number(e), {}, nullptr};
  }

  std::string condition(const Expression& e) {
    switch (e.op) {
      case Op::truth: return e.number != 0 ? "true" : "false";
      case Op::known: return "(" + operand(e.parts[0]).text + " IS NOT NULL)";
      case Op::all: return joined(e, " AND ");
      case Op::any: return joined(e, " OR ");
      case Op::negation: return "(NOT " + condition(e.parts[0]) + ")";
      case Op::holds: {
        const Sql sql = operand(e.parts[0]);
        if (sql.kind != Kind::truth)
          refuse(wrong(e.parts[0], sql, Kind::truth) + ": compare it with a value", e.parts[0]);
        return sql.text;
      }
      case Op::like: {
        const std::string like = text(e.parts[0]);
        return "(" + like + " LIKE " + text(e.parts[1]) + ")";
      }
      case Op::valid: refuse("'" + e.name.substr(0, 100) + "' is not a column", e); return {};
      default: break;
    }
    const Operator& row = *find_operator(e.op);
    switch (row.form) {
      case Operator::Form::time_function:
        return of_times(row.times_sql, time(e.parts[0]), time(e.parts[1]));
      case Operator::Form::key_function: return of_keys(e, row);
      default: return comparison(e, row);
    }
  }

  std::string joined(const Expression& e, const char* word) {
    std::string sql;
    for (const Expression& part : e.parts) sql += (sql.empty() ? "(" : word) + condition(part);
    return sql + ")";
  }

  std::string comparison(const Expression& e, const Operator& row) {
    // The other operand determines how a text is read.
    const bool turned = e.parts[0].op == Op::text;
    const Expression &first = e.parts[turned ? 1 : 0], &second = e.parts[turned ? 0 : 1];
    const Sql a = operand(first);
    if (a.kind == Kind::time) {
      const Sql b = time(second);
      return turned ? of_times(row.times_sql, b, a) : of_times(row.times_sql, a, b);
    }
    if (a.kind == Kind::keys || a.kind == Kind::truth || a.kind == Kind::features)
      refuse(wrong(first, a, Kind::number) + (a.kind == Kind::keys ? ": use a_contains(…, (key))"
                                              : a.kind == Kind::features ? ": use 'is null'"
                                                                         : ""),
             first);
    if (a.kind == Kind::text) check_choice(a, second);
    if (a.kind == Kind::number && second.is_text()) refuse(wrong(first, a, Kind::text), first);
    const std::string b = a.kind == Kind::text ? text(second) : number(second);
    return turned ? of_operands(row.sql, b, a.text) : of_operands(row.sql, a.text, b);
  }

  void check_choice(const Sql& column, const Expression& text) {
    if (!column.column || column.column->kind != ColumnKind::enumeration || text.op != Op::text)
      return;
    const auto& choices = column.column->choices;
    if (std::find(choices.begin(), choices.end(), text.text) != choices.end()) return;
    std::string known;
    for (const auto& choice : choices)
      if (known.size() < 300) known += (known.empty() ? "" : ", ") + choice.substr(0, 100);
    refuse("'" + text.text.substr(0, 100) + "' is not a choice of " + column.column->slug +
               ". Its choices are " + known,
           text, mistake::kUnknownChoice, similar_choices(text.text, choices));
  }

  static std::vector<std::string> similar_choices(const std::string& text,
                                                  std::span<const std::string> choices) {
    std::vector<std::string> similar = closest_names(text, choices);
    for (std::string& each : similar) each = query::text_in_expression(each);
    return similar;
  }

  std::string of_keys(const Expression& e, const Operator& row) {
    const Sql relation = operand(e.parts[0]);
    if (relation.kind != Kind::keys) refuse(wrong(e.parts[0], relation, Kind::keys), e.parts[0]);
    std::vector<std::int64_t> keys;
    for (const Expression& part : e.parts[1].parts) {
      if (part.op != Op::number || !(part.number >= 0 && part.number <= kMaxRecordKey) ||
          part.number != std::floor(part.number)) {
        refuse("A key must be a whole number from 0 to 4294967295", part);
        return {};
      }
      keys.push_back(static_cast<std::int64_t>(part.number));
    }
    std::sort(keys.begin(), keys.end());  // relations are stored in this order
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    PgArray array(oid::kInt8);
    for (const auto key : keys) array.add(key);
    params_.array(array);
    return of_operands(row.sql, relation.text, parameter());
  }

  const Table& table_;
  const Role seen_by_;
  PgConnection& connection_;
  Params& params_;
  const std::string& field_;
  std::map<TableId, Table> targets_;
  int aliases_ = 0;
  std::optional<Error> problem_;
};

}  // namespace

Result<std::string> condition_sql(const Expression& condition, const OpenTable& open,
                                  PgConnection& connection, Params& params,
                                  const std::string& field) {
  return Writer(open, connection, params, field).write(condition, Kind::truth);
}

Result<std::string> number_sql(const Expression& number, const OpenTable& open,
                               PgConnection& connection, Params& params, const std::string& field) {
  return Writer(open, connection, params, field).write(number, Kind::number);
}

Error unanswerable(const PgConnection& connection, Error problem, const std::string& field) {
  if (!connection.sqlstate().starts_with("22")) return problem;
  return {ErrorCode::invalid, "Number out of range",
          "A result of this expression is outside the range of double precision.", field};
}

}  // namespace strata::store
