#include "store/tables/record_sql.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>

#include "core/text/edtf.h"
#include "core/text/timestamp.h"
#include "store/tables/table_writer.h"

namespace strata::store {
namespace {

using Op = Expression::Op;

// Days as doubles tell milliseconds apart for some 100 000 years.
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

// Part of a statement. A time is two: days since 1970 when it begins and, in `end`, its last
// moment.
struct Sql {
  Kind kind = Kind::number;
  std::string text, end;
  const Column* column = nullptr;  // where it is nothing but that
};

// A value of a function of one or two numbers where it has one; these are computed once, whatever
// the function says of them.
std::string of_one(const std::string& a, const std::string& value) {
  return "(SELECT " + value + " FROM (SELECT " + a + " AS a) q)";
}
std::string of_two(const std::string& a, const std::string& b, const std::string& value) {
  return "(SELECT " + value + " FROM (SELECT " + a + " AS a, " + b + " AS b) q)";
}

class Writer {
 public:
  Writer(const OpenTable& open, PgConnection& connection, Params& params, const std::string& field)
      : table_(open.table),
        seen_by_(open.seen_by),
        connection_(connection),
        params_(params),
        field_(field) {}

  Result<std::string> write(const Expression& expression, Kind wanted) {
    const std::string sql = wanted == Kind::truth ? condition(expression) : number(expression);
    if (problem_) return tl::unexpected(*problem_);
    return sql;
  }

 private:
  // The first refusal is kept; what is written after it is never read.
  Sql refuse(const std::string& what, const Expression& at) {
    if (!problem_) problem_ = expression_problem(what, at.position.at, field_);
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

  static std::string name_of(const Column& column) { return "c" + std::to_string(column.id); }

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
    // How a column of the row at hand is reached, by its name in the database.
    std::function<std::string(const std::string&)> reach = [](const std::string& name) {
      return "t." + name;
    };
    const Table* table = &table_;
    for (std::size_t step = 0; step + 1 < e.path.size(); ++step) {
      const Column* column = find_column(table->columns, e.path[step]);
      if (column == nullptr) return no_column(*table, e, step);
      if (column->kind != ColumnKind::term)
        return refuse("'" + column->slug + "' holds no key of another table's record", e);
      const Table* target = target_of(*column);
      if (target == nullptr) return {};
      const std::string alias = "u" + std::to_string(++aliases_), key = reach(name_of(*column));
      reach = [alias, key, id = target->id](const std::string& name) {
        return "(SELECT " + alias + "." + name + " FROM records.t" + std::to_string(id) + " " +
               alias + " WHERE " + alias + ".key = " + key + ")";
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
                      "'; it has " + some_columns(table),
                  e);
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
    const std::string inside = text(e.parts[0]);
    if (e.op == Op::fold_case) return "lower(" + inside + ")";
    return "regexp_replace(normalize(" + inside + ", NFD), '[\\u0300-\\u036f]', '', 'g')";
  }

  std::string text(const Expression& e) {
    if (e.op == Op::text) return parameter(e.text);
    if (e.is_text()) return fold(e);
    const Sql sql = operand(e);
    if (sql.kind != Kind::text) refuse(wrong(e, sql, Kind::text), e);
    return sql.text;
  }

  static std::string wrong(const Expression& e, const Sql& sql, Kind wanted) {
    const std::string what =
        e.is_column() ? "'" + e.path.back().substr(0, 100) + "' holds " : "These are ";
    std::string advice;
    if (sql.column && sql.column->kind == ColumnKind::term && wanted == Kind::text)
      advice = "; name a column of the record behind the key, as in " + sql.column->slug + ".code";
    return what + in_words(sql.kind) + ", not " + in_words(wanted) + advice;
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
      return refuse("'" + e.text.substr(0, 100) + "' is no date; dates are written 2024-05-02", e);
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
        return of_one(when, "CASE WHEN a THEN " + then + " WHEN NOT a THEN " + otherwise + " END");
      }
      case Op::negate: return "(- " + number(e.parts[0]) + ")";
      case Op::absolute: return "abs(" + number(e.parts[0]) + ")";
      case Op::add: return infix(e, "+");
      case Op::subtract: return infix(e, "-");
      case Op::multiply: return infix(e, "*");
      case Op::divide:
        return "(" + number(e.parts[0]) + " / nullif(" + number(e.parts[1]) + ", 0))";
      case Op::remainder: return binary(e, "CASE WHEN b <> 0 THEN a - b * trunc(a / b) END");
      case Op::whole_division:
        return "trunc(" + number(e.parts[0]) + " / nullif(" + number(e.parts[1]) + ", 0))";
      case Op::power:
        return binary(
            e,
            "CASE WHEN a > 0 OR (a = 0 AND b >= 0) OR (a < 0 AND b = trunc(b)) THEN power(a, b) END");
      case Op::least: return folded(e, "CASE WHEN a <= b THEN a WHEN b < a THEN b END");
      case Op::greatest: return folded(e, "CASE WHEN a >= b THEN a WHEN b > a THEN b END");
      case Op::square_root: return unary(e, "CASE WHEN a >= 0 THEN sqrt(a) END");
      case Op::exponential: return unary(e, "exp(a)");
      case Op::natural_log: return unary(e, "CASE WHEN a > 0 THEN ln(a) END");
      case Op::decimal_log: return unary(e, "CASE WHEN a > 0 THEN log(a) END");
      case Op::floor: return unary(e, "floor(a)");
      case Op::ceiling: return unary(e, "ceil(a)");
      case Op::round: return unary(e, "sign(a) * floor(abs(a) + 0.5)");
      case Op::sine: return unary(e, "sin(a)");
      case Op::cosine: return unary(e, "cos(a)");
      case Op::tangent: return unary(e, "tan(a)");
      case Op::arc_sine: return unary(e, "CASE WHEN abs(a) <= 1 THEN asin(a) END");
      case Op::arc_cosine: return unary(e, "CASE WHEN abs(a) <= 1 THEN acos(a) END");
      case Op::arc_tangent: return unary(e, "atan(a)");
      case Op::radians: return unary(e, "radians(a)");
      case Op::degrees: return unary(e, "degrees(a)");
      case Op::layer: refuse("'" + e.name.substr(0, 100) + "' is no column", e); return {};
      default: refuse("A number is wanted here", e); return {};
    }
  }

  std::string infix(const Expression& e, const char* sign) {
    return "(" + number(e.parts[0]) + " " + sign + " " + number(e.parts[1]) + ")";
  }
  std::string unary(const Expression& e, const char* value) {
    return of_one(number(e.parts[0]), value);
  }
  std::string binary(const Expression& e, const char* value) {
    const std::string a = number(e.parts[0]);
    return of_two(a, number(e.parts[1]), value);
  }
  std::string folded(const Expression& e, const char* value) {
    std::string all = number(e.parts[0]);
    for (std::size_t part = 1; part < e.parts.size(); ++part)
      all = of_two(all, number(e.parts[part]), value);
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
          refuse(wrong(e.parts[0], sql, Kind::truth) + ": compare it with something", e.parts[0]);
        return sql.text;
      }
      case Op::like: {
        const std::string like = text(e.parts[0]);
        return "(" + like + " LIKE " + text(e.parts[1]) + ")";
      }
      case Op::before:
      case Op::after:
      case Op::during:
      case Op::contains:
      case Op::intersects:
      case Op::disjoint:
      case Op::coincides: return of_times(e);
      case Op::has_all: return of_keys(e, "@>");
      case Op::has_any: return of_keys(e, "&&");
      case Op::has_only: return of_keys(e, "<@");
      case Op::has_exactly: return of_keys(e, "=");
      case Op::valid: refuse("'" + e.name.substr(0, 100) + "' is no column", e); return {};
      default: return comparison(e);
    }
  }

  std::string joined(const Expression& e, const char* word) {
    std::string sql;
    for (const Expression& part : e.parts) sql += (sql.empty() ? "(" : word) + condition(part);
    return sql + ")";
  }

  static const char* sign_of(Op op) {
    switch (op) {
      case Op::less: return " < ";
      case Op::less_equal: return " <= ";
      case Op::greater: return " > ";
      case Op::greater_equal: return " >= ";
      case Op::equal: return " = ";
      default: return " <> ";
    }
  }

  std::string comparison(const Expression& e) {
    // A text means what the other side holds.
    const bool turned = e.parts[0].op == Op::text;
    const Expression &first = e.parts[turned ? 1 : 0], &second = e.parts[turned ? 0 : 1];
    const Sql a = operand(first);
    if (a.kind == Kind::time) {
      const Sql b = time(second);
      return turned ? comparison_of_times(e.op, b, a) : comparison_of_times(e.op, a, b);
    }
    if (a.kind == Kind::keys || a.kind == Kind::truth || a.kind == Kind::features)
      refuse(
          wrong(first, a, Kind::number) + (a.kind == Kind::keys ? ": ask a_contains(…, (key))"
                                           : a.kind == Kind::features ? ": ask whether it is null"
                                                                      : ""),
          first);
    if (a.kind == Kind::text) check_choice(a, second);
    if (a.kind == Kind::number && second.is_text()) refuse(wrong(first, a, Kind::text), first);
    const std::string b = a.kind == Kind::text ? text(second) : number(second);
    return "(" + (turned ? b : a.text) + sign_of(e.op) + (turned ? a.text : b) + ")";
  }

  void check_choice(const Sql& column, const Expression& text) {
    if (!column.column || column.column->kind != ColumnKind::enumeration || text.op != Op::text)
      return;
    const auto& choices = column.column->choices;
    if (std::find(choices.begin(), choices.end(), text.text) != choices.end()) return;
    std::string known;
    for (const auto& choice : choices)
      if (known.size() < 300) known += (known.empty() ? "" : ", ") + choice.substr(0, 100);
    refuse("'" + text.text.substr(0, 100) + "' is no choice of " + column.column->slug +
               "; there are " + known,
           text);
  }

  // What lies before has ended, what lies after has not begun; up to and from it include it.
  static std::string comparison_of_times(Op op, const Sql& a, const Sql& b) {
    switch (op) {
      case Op::less: return "(" + a.end + " < " + b.text + ")";
      case Op::less_equal: return "(" + a.end + " <= " + b.end + ")";
      case Op::greater: return "(" + a.text + " > " + b.end + ")";
      case Op::greater_equal: return "(" + a.text + " >= " + b.text + ")";
      case Op::equal: return "(" + a.text + " = " + b.text + " AND " + a.end + " = " + b.end + ")";
      default: return "(" + a.text + " <> " + b.text + " OR " + a.end + " <> " + b.end + ")";
    }
  }

  std::string of_times(const Expression& e) {
    const Sql a = time(e.parts[0]), b = time(e.parts[1]);
    const auto within = [](const Sql& inner, const Sql& outer) {
      return "(" + inner.text + " >= " + outer.text + " AND " + inner.end + " <= " + outer.end +
             ")";
    };
    const std::string meet =
        "(" + a.text + " <= " + b.end + " AND " + b.text + " <= " + a.end + ")";
    switch (e.op) {
      case Op::before: return "(" + a.end + " < " + b.text + ")";
      case Op::after: return "(" + a.text + " > " + b.end + ")";
      case Op::during: return within(a, b);
      case Op::contains: return within(b, a);
      case Op::intersects: return meet;
      case Op::disjoint: return "(NOT " + meet + ")";
      default: return "(" + a.text + " = " + b.text + " AND " + a.end + " = " + b.end + ")";
    }
  }

  std::string of_keys(const Expression& e, const char* sign) {
    const Sql relation = operand(e.parts[0]);
    if (relation.kind != Kind::keys) refuse(wrong(e.parts[0], relation, Kind::keys), e.parts[0]);
    std::vector<std::int64_t> keys;
    for (const Expression& part : e.parts[1].parts) {
      if (part.op != Op::number || !(part.number >= 0 && part.number <= kMaxRecordKey) ||
          part.number != std::floor(part.number)) {
        refuse("Keys are whole numbers from 0 to 4294967295", part);
        return {};
      }
      keys.push_back(static_cast<std::int64_t>(part.number));
    }
    std::sort(keys.begin(), keys.end());  // as relations are kept
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    PgArray array(oid::kInt8);
    for (const auto key : keys) array.add(key);
    params_.array(array);
    return "(" + relation.text + " " + sign + " " + parameter() + ")";
  }

  const Table& table_;
  const Role seen_by_;
  PgConnection& connection_;
  Params& params_;
  const std::string& field_;
  std::map<std::int64_t, Table> targets_;
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
          "A number that this expression computes leaves the range of double precision.", field};
}

}  // namespace strata::store
