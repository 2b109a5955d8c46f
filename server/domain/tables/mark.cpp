#include "domain/tables/mark.h"

#include <charconv>
#include <cmath>

#include "core/text/csv.h"

namespace strata {
namespace {

using nlohmann::json;

bool is_place(const json& value) {
  if (!value.is_array() || value.size() != 3) return false;
  for (const json& number : value)
    if (!number.is_number() || !(std::abs(number.get<double>()) <= kFarthestPlace)) return false;
  return true;
}
glm::dvec3 place_of(const json& value) {
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}
json to_json(const glm::dvec3& place) { return {place.x, place.y, place.z}; }

bool fits(const std::vector<Mark>& marks, bool lines) {
  std::size_t places = 0;
  for (const Mark& mark : marks) {
    places += mark.places.size();
    if (mark.model < 1 ||
        (lines ? mark.places.size() < 2 || length_of(mark) == 0 : mark.places.size() != 1))
      return false;
  }
  return marks.size() <= kMostMarks && places <= kMostMarkPlaces;
}

// Reads what print_marks writes, with spaces wherever they may stand.
class MarkReader {
 public:
  MarkReader(std::string_view text, bool lines) : rest_(text), lines_(lines) {}

  std::optional<std::vector<Mark>> read() {
    std::vector<Mark> marks;
    do {
      skip_blank();
      if (rest_.empty() && !marks.empty()) break;  // a semicolon at the end
      Mark mark;
      if (marks.size() == kMostMarks || !number(mark.model) ||
          !word(lines_ ? "LINESTRING" : "POINT") || !word("Z") || !sign('('))
        return std::nullopt;
      do {
        glm::dvec3 place(0);
        if (!number(place.x) || !number(place.y) || !number(place.z) ||
            mark.places.size() == kMostMarkPlaces)
          return std::nullopt;
        mark.places.push_back(place);
      } while (sign(','));
      if (!sign(')')) return std::nullopt;
      marks.push_back(std::move(mark));
    } while (sign(';'));
    if (!rest_.empty()) return std::nullopt;
    return marks;
  }

 private:
  void skip_blank() {
    while (!rest_.empty() && (rest_.front() == ' ' || rest_.front() == '\t' ||
                              rest_.front() == '\n' || rest_.front() == '\r'))
      rest_.remove_prefix(1);
  }
  bool sign(char wanted) {
    skip_blank();
    if (rest_.empty() || rest_.front() != wanted) return false;
    rest_.remove_prefix(1);
    skip_blank();
    return true;
  }
  bool word(std::string_view wanted) {
    skip_blank();
    if (rest_.size() < wanted.size()) return false;
    for (std::size_t i = 0; i < wanted.size(); ++i)
      if ((rest_[i] & ~0x20) != wanted[i]) return false;
    rest_.remove_prefix(wanted.size());
    return true;
  }
  template <class Number>
  bool number(Number& value) {
    skip_blank();
    const auto [end, error] = std::from_chars(rest_.data(), rest_.data() + rest_.size(), value);
    if (error != std::errc()) return false;
    rest_.remove_prefix(static_cast<std::size_t>(end - rest_.data()));
    return true;
  }

  std::string_view rest_;
  const bool lines_;
};

}  // namespace

std::optional<std::vector<Mark>> read_marks(const json& value, bool lines) {
  if (!value.is_array() || value.size() > kMostMarks) return std::nullopt;
  std::vector<Mark> marks;
  for (const json& item : value) {
    if (!item.is_object() || item.size() != 2) return std::nullopt;
    const auto model = item.find("model"), coordinates = item.find("coordinates");
    if (model == item.end() || coordinates == item.end() || !model->is_number_integer() ||
        !coordinates->is_array() || coordinates->size() > kMostMarkPlaces)
      return std::nullopt;
    Mark mark{model->get<std::int64_t>(), {}};
    for (const json& place : *coordinates) {
      if (!is_place(place)) return std::nullopt;
      mark.places.push_back(place_of(place));
    }
    marks.push_back(std::move(mark));
  }
  if (!fits(marks, lines)) return std::nullopt;
  return marks;
}

std::vector<Mark> marks_of(const Record& record, const Column& column) {
  const auto cell = record.values.find(column.id);
  if (cell == record.values.end()) return {};
  return read_marks(cell->second, column.kind == ColumnKind::line).value_or(std::vector<Mark>());
}

json to_json(std::span<const Mark> marks) {
  json list = json::array();
  for (const Mark& mark : marks) {
    json coordinates = json::array();
    for (const glm::dvec3& place : mark.places) coordinates.push_back(to_json(place));
    list.push_back({{"model", mark.model}, {"coordinates", std::move(coordinates)}});
  }
  return list;
}

std::string print_marks(std::span<const Mark> marks, bool lines) {
  std::string text;
  for (const Mark& mark : marks) {
    text += (text.empty() ? "" : "; ") + std::to_string(mark.model) +
            (lines ? " LINESTRING Z (" : " POINT Z (");
    for (std::size_t i = 0; i < mark.places.size(); ++i) {
      if (i > 0) text += ", ";
      for (int axis = 0; axis < 3; ++axis) {
        if (axis > 0) text += ' ';
        text += csv_number(mark.places[i][axis], ',');
      }
    }
    text += ')';
  }
  return text;
}

std::optional<std::vector<Mark>> parse_marks(std::string_view text, bool lines) {
  auto marks = MarkReader(text, lines).read();
  if (!marks || !fits(*marks, lines)) return std::nullopt;
  for (const Mark& mark : *marks)
    for (const glm::dvec3& place : mark.places)
      for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(place[axis]) <= kFarthestPlace)) return std::nullopt;
  return marks;
}

double length_of(const Mark& mark) {
  double length = 0;
  for (std::size_t i = 1; i < mark.places.size(); ++i)
    length += glm::distance(mark.places[i - 1], mark.places[i]);
  return length;
}

}  // namespace strata
