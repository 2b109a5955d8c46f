#include "domain/tables/column_value.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/text/ascii.h"
#include "core/text/csv.h"
#include "core/text/edtf.h"
#include "core/text/timestamp.h"
#include "core/text/utf8.h"
#include "domain/tables/surface_feature.h"

namespace strata {
namespace {

using nlohmann::json;

tl::unexpected<Error> refuse(const Column& column, const std::string& what,
                             const std::string& field) {
  return fail(ErrorCode::invalid, "Invalid value",
              "\"" + column.name + "\" can contain only " + what + ".", field);
}

std::string number_text(double number) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, number).ptr};
}

Result<json> check_limits(const Column& column, double number, json value,
                          const std::string& field) {
  if (column.minimum && number < *column.minimum)
    return fail(ErrorCode::invalid, "Value out of range",
                "\"" + column.name + "\" must be at least " + number_text(*column.minimum) + ".",
                field);
  if (column.maximum && number > *column.maximum)
    return fail(ErrorCode::invalid, "Value out of range",
                "\"" + column.name + "\" must be at most " + number_text(*column.maximum) + ".",
                field);
  return value;
}

Result<json> check_integer(const Column& column, const json& value, const std::string& field) {
  // Accepts a whole number that is written as 3.0 or 1e3.
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!(std::abs(number) <= static_cast<double>(kGreatestInteger)) || std::trunc(number) != number)
    return refuse(column, "whole numbers of at most 2^53", field);
  return check_limits(column, number, static_cast<std::int64_t>(number), field);
}

Result<json> check_numeric(const Column& column, const json& value, const std::string& field) {
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!std::isfinite(number)) return refuse(column, "finite numbers", field);
  // Replaces -0 by 0, because both are 0 as text.
  return check_limits(column, number, number == 0 ? 0.0 : number, field);
}

Result<std::string> check_text(const Column& column, const json& value, const char* what,
                               const std::string& field) {
  if (!value.is_string()) return refuse(column, what, field);
  const auto& text = value.get_ref<const std::string&>();
  if (text.size() > kMaxTextLength || !is_utf8(text) || text.find('\0') != std::string::npos)
    return refuse(column,
                  "UTF-8 of at most " + std::to_string(kMaxTextLength) + " bytes, without U+0000",
                  field);
  return text;
}

Result<json> check_url(const Column& column, const std::string& text, const std::string& field) {
  // Accepts only schemes that a browser opens without running code.
  const bool known = text.starts_with("https://") || text.starts_with("http://") ||
                     text.starts_with("mailto:") || text.starts_with("urn:") ||
                     text.starts_with("doi:");
  const bool clean = std::none_of(text.begin(), text.end(), [](char c) {
    return static_cast<unsigned char>(c) <= ' ' || c == 127 || c == '<' || c == '>' || c == '"' ||
           c == '\\';
  });
  if (!known || !clean || text.back() == ':' || text.ends_with("://"))
    return refuse(
        column,
        "addresses that begin with https://, http://, mailto:, urn: or doi:, without spaces",
        field);
  return json(text);
}

std::optional<std::int64_t> key_of(const json& value) {
  const double number = value.is_number() ? value.get<double>() : NAN;
  if (!(number >= 0 && number <= static_cast<double>(kMaxRecordKey)) ||
      std::trunc(number) != number)
    return std::nullopt;
  return static_cast<std::int64_t>(number);
}

Result<json> check_relation(const Column& column, const json& value, const std::string& field) {
  if (!value.is_array()) return refuse(column, "a list of keys", field);
  if (value.size() > kMaxRelated)
    return refuse(column, "lists of at most " + std::to_string(kMaxRelated) + " keys", field);
  std::vector<std::int64_t> keys;
  for (const json& item : value) {
    const auto key = key_of(item);
    if (!key) return refuse(column, "a list of keys, each from 0 to 4294967295", field);
    keys.push_back(*key);
  }
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  if (keys.empty()) return json();
  return json(keys);
}

Result<json> check_attached(const Column& column, const json& value, const std::string& field) {
  if (!value.is_array() || value.size() > kMaxAttached)
    return refuse(
        column, "a list of at most " + std::to_string(kMaxAttached) + " ids of attachments", field);
  json ids = json::array();
  for (const json& item : value) {
    const double number = item.is_number() ? item.get<double>() : NAN;
    if (!(number >= 1 && number <= static_cast<double>(kGreatestInteger)) ||
        std::trunc(number) != number)
      return refuse(column, "a list of ids of attachments", field);
    const json id = static_cast<std::int64_t>(number);
    if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
  }
  if (ids.empty()) return json();
  return ids;
}

Result<json> check_features(const Column& column, const json& value, const std::string& field) {
  const bool lines = column.kind == ColumnKind::line;
  const auto features = read_features(value, lines);
  if (!features)
    return refuse(
        column,
        std::string(
            lines
                ? R"(a list of lines, {"model": 3, "coordinates": [[x, y, z], [x, y, z], …]} each)"
                : R"(a list of points, {"model": 3, "coordinates": [[x, y, z]]} each)") +
            ", " + std::to_string(kMaxFeatures) + " and " + std::to_string(kMaxFeaturePlaces) +
            " points at most",
        field);
  if (features->empty()) return json();
  return to_json(*features);
}

Result<json> check_present(const Column& column, const json& value, const std::string& field) {
  switch (column.kind) {
    case ColumnKind::integer: return check_integer(column, value, field);
    case ColumnKind::numeric: return check_numeric(column, value, field);
    case ColumnKind::boolean:
      return value.is_boolean() ? Result<json>(value) : refuse(column, "true or false", field);
    case ColumnKind::term: {
      const auto key = key_of(value);
      return key ? Result<json>(*key)
                 : refuse(column, "the key of a record, from 0 to 4294967295", field);
    }
    case ColumnKind::relation: return check_relation(column, value, field);
    case ColumnKind::picture:
    case ColumnKind::document: return check_attached(column, value, field);
    case ColumnKind::line:
    case ColumnKind::point: return check_features(column, value, field);
    default: break;
  }
  auto text = STRATA_TRY(check_text(column, value, "text", field));
  if (trimmed(text).empty()) return json();
  switch (column.kind) {
    case ColumnKind::date:
      return day_of(text) ? Result<json>(text)
                          : refuse(column, "dates such as 2024-02-29, from year 1 on", field);
    case ColumnKind::timestamp: {
      auto utc = utc_timestamp(text);
      return utc ? Result<json>(std::move(*utc))
                 : refuse(column, "times such as 2024-02-29T12:00:00Z", field);
    }
    case ColumnKind::period: {
      auto period = parse_edtf(text);
      if (period) return json(std::move(text));
      period.error().field = field;
      return tl::unexpected(period.error());
    }
    case ColumnKind::enumeration: {
      if (std::find(column.choices.begin(), column.choices.end(), text) != column.choices.end())
        return json(text);
      std::string choices;
      for (const auto& choice : column.choices) {
        if (choices.size() > 200) {
          choices += ", …";
          break;
        }
        choices += (choices.empty() ? "" : ", ") + choice;
      }
      return refuse(column, "one of: " + choices, field);
    }
    case ColumnKind::url: return check_url(column, text, field);
    default: return json(std::move(text));
  }
}

std::optional<double> parse_number(std::string_view text, bool decimal_comma) {
  std::string plain(text);
  if (plain.starts_with('+')) plain.erase(0, 1);
  if (decimal_comma && plain.find('.') == std::string::npos &&
      std::count(plain.begin(), plain.end(), ',') == 1)
    plain[plain.find(',')] = '.';
  double number = 0;
  const auto [end, error] = std::from_chars(plain.data(), plain.data() + plain.size(), number);
  if (error != std::errc() || end != plain.data() + plain.size() || !std::isfinite(number))
    return std::nullopt;
  return number;
}

std::optional<bool> parse_boolean(std::string_view text) {
  std::string lower(text);
  std::transform(lower.begin(), lower.end(), lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  if (lower == "true" || lower == "yes" || lower == "1") return true;
  if (lower == "false" || lower == "no" || lower == "0") return false;
  return std::nullopt;
}

std::string plain_text(const json& value) {
  if (value.is_null()) return {};
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "true" : "false";
  if (value.is_number_float()) return number_text(value.get<double>());
  if (value.is_number()) return std::to_string(value.get<std::int64_t>());
  std::string keys;
  for (const json& key : value)
    keys += (keys.empty() ? "" : " ") + std::to_string(key.get<std::int64_t>());
  return keys;
}

bool is_free_text(ColumnKind kind) {
  return kind == ColumnKind::text || kind == ColumnKind::enumeration || kind == ColumnKind::url;
}

}  // namespace

Result<json> check_value(const Column& column, const json& value, const std::string& field) {
  Result<json> checked =
      value.is_null() ? Result<json>(json()) : check_present(column, value, field);
  if (checked && checked->is_null() && column.required)
    return fail(ErrorCode::invalid, "Value missing", "\"" + column.name + "\" needs a value.",
                field);
  return checked;
}

Result<json> parse_value(const Column& column, std::string_view text, bool decimal_comma,
                         const std::string& field) {
  const std::string_view bare = trimmed(text);
  if (bare.empty()) return check_value(column, json(), field);
  switch (column.kind) {
    case ColumnKind::integer:
    case ColumnKind::numeric:
    case ColumnKind::term: {
      const auto number = parse_number(bare, decimal_comma);
      return check_value(column, number ? json(*number) : json(std::string(bare)), field);
    }
    case ColumnKind::boolean: {
      const auto truth = parse_boolean(bare);
      return check_value(column, truth ? json(*truth) : json(std::string(bare)), field);
    }
    case ColumnKind::relation:
    case ColumnKind::picture:
    case ColumnKind::document: {
      json keys = json::array();
      for (std::size_t at = 0; at < bare.size();) {
        const std::size_t end = std::min(bare.find_first_of(" ;", at), bare.size());
        if (end > at) {
          const auto number = parse_number(bare.substr(at, end - at), false);
          keys.push_back(number ? json(*number) : json(std::string(bare.substr(at, end - at))));
        }
        at = end + 1;
      }
      return check_value(column, keys, field);
    }
    case ColumnKind::line:
    case ColumnKind::point: {
      const bool lines = column.kind == ColumnKind::line;
      const auto features = parse_features(bare, lines);
      if (!features)
        return refuse(
            column,
            lines ? "lines as `3 LINESTRING Z (0 0 1, 2.5 0 1)` (model 3), separated by semicolons"
                  : "points as `3 POINT Z (0 0 1)` (model 3), separated by semicolons",
            field);
      return check_value(column, to_json(*features), field);
    }
    default: break;
  }
  return check_value(
      column, is_free_text(column.kind) ? unguard_formula(std::string(text)) : std::string(bare),
      field);
}

std::string print_value(const Column& column, const json& value) {
  if (holds_features(column.kind)) {
    const bool lines = column.kind == ColumnKind::line;
    const auto features = read_features(value, lines);
    return features ? print_features(*features, lines) : std::string();
  }
  return is_free_text(column.kind) ? guard_formula(plain_text(value)) : plain_text(value);
}

Result<json> convert_value(const Column& from, const Column& to, const json& value,
                           const std::string& field) {
  if (value.is_null()) return check_value(to, value, field);
  if (from.kind == ColumnKind::timestamp &&
      (to.kind == ColumnKind::date || to.kind == ColumnKind::period))
    return check_value(to, value.get_ref<const std::string&>().substr(0, 10), field);
  // A key of one table is invalid in other tables.
  const bool from_keys = from.target.has_value(), to_keys = to.target.has_value();
  if (from_keys && to_keys && from.target != to.target)
    return refuse(to, "keys of a different table than \"" + from.name + "\"", field);
  if (holds_attachments(to.kind))
    return holds_attachments(from.kind) ? check_value(to, value, field)
                                        : refuse(to, "files", field);
  if (holds_features(to.kind) && !holds_features(from.kind) && !is_free_text(from.kind))
    return refuse(to, "lines or points", field);
  const std::string text = holds_features(from.kind) ? print_value(from, value) : plain_text(value);
  if (is_free_text(to.kind)) return check_value(to, text, field);
  return parse_value(to, text, false, field);
}

}  // namespace strata
