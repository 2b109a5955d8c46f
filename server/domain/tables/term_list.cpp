#include "domain/tables/term_list.h"

#include <algorithm>
#include <cmath>

#include "core/text/search_text.h"
#include "domain/tables/label_text.h"

namespace strata {
namespace {

std::string text_of(const Record& record, const Column* column) {
  if (!column) return {};
  const auto value = record.values.find(column->id);
  if (value == record.values.end() || !value->second.is_string()) return {};
  return value->second.get<std::string>();
}

Rgba color_of_text(const std::string& text) {
  const auto number = [&](std::size_t at) {
    return static_cast<std::uint8_t>(std::stoi(text.substr(at, 2), nullptr, 16));
  };
  return {number(1), number(3), number(5), 255};
}

// Returns the nth distinguishable shade of `color`, alternately lighter and darker.
Rgba shade(const Rgba& color, int nth) {
  const double part = std::min(0.6, 0.2 * (nth / 2 + 1));
  const double end = nth % 2 == 0 ? 255 : 0;
  Rgba out = color;
  for (int i = 0; i < 3; ++i)
    out[i] = static_cast<std::uint8_t>(std::lround(color[i] + (end - color[i]) * part));
  return out;
}

Pattern pattern_of(const Term& term) {
  const auto known = std::find(std::begin(kTermPatterns), std::end(kTermPatterns), term.pattern);
  return known == std::end(kTermPatterns) ? Pattern::solid
                                          : static_cast<Pattern>(known - std::begin(kTermPatterns));
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    if (end > begin) words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

}  // namespace

std::optional<TermColumns> term_columns(const Table& table) {
  TermColumns out;
  for (const Column& column : table.columns) {
    const bool is_text = column.kind == ColumnKind::text;
    if (column.slug == "code" && is_text && column.required && column.unique) out.code = &column;
    if (column.slug == "label" && is_text) out.label = &column;
    if (column.slug == "parent" && column.kind == ColumnKind::term && column.target == table.id)
      out.parent = &column;
    if (column.slug == "definition" && is_text) out.definition = &column;
    if (column.slug == "uri" && (is_text || column.kind == ColumnKind::url)) out.uri = &column;
    if (column.slug == "color" && is_text) out.color = &column;
    if (column.slug == "pattern" && (is_text || column.kind == ColumnKind::enumeration))
      out.pattern = &column;
    if (const auto language = label_language(column.slug); language && is_text)
      out.labels[*language] = &column;
  }
  if (!out.code || !out.label || !out.parent) return std::nullopt;
  return out;
}

Column new_term_column(const std::string& slug) {
  struct Known {
    const char *slug, *name, *spanish;
    ColumnKind kind;
  };
  static constexpr Known kKnown[] = {{"code", "Code", "Código", ColumnKind::text},
                                     {"label", "Label", "Etiqueta", ColumnKind::text},
                                     {"parent", "Parent", "Término superior", ColumnKind::term},
                                     {"definition", "Definition", "Definición", ColumnKind::text},
                                     {"uri", "URI", "URI", ColumnKind::url},
                                     {"color", "Colour", "Color", ColumnKind::text},
                                     {"pattern", "Pattern", "Trama", ColumnKind::enumeration}};
  Column column;
  column.slug = slug;
  for (const Known& known : kKnown)
    if (slug == known.slug) {
      column.name = known.name;
      column.labels = {{"es", known.spanish}};
      column.kind = known.kind;
    }
  if (const auto language = label_language(slug)) {
    column.name = "Label (" + *language + ")";
    column.labels = {{"es", "Etiqueta (" + *language + ")"}};
  }
  column.required = column.unique = slug == "code";
  if (slug == "parent") column.target = kOwnTable;
  if (slug == "pattern") column.choices.assign(std::begin(kTermPatterns), std::end(kTermPatterns));
  return column;
}

std::vector<Column> new_term_columns(std::span<const std::string> languages) {
  std::vector<Column> columns{new_term_column("code"), new_term_column("label")};
  for (const std::string& language : languages)
    columns.push_back(new_term_column(label_slug(language)));
  for (const char* slug : {"parent", "definition", "uri", "color", "pattern"})
    columns.push_back(new_term_column(slug));
  return columns;
}

std::vector<ListedTerm> list_terms(const TermColumns& columns, std::span<const Record> records) {
  std::map<std::int64_t, ListedTerm> terms;
  for (const Record& record : records) {
    ListedTerm listed;
    listed.key = record.key;
    if (const auto parent = record.values.find(columns.parent->id);
        parent != record.values.end() && parent->second.is_number())
      listed.parent = parent->second.get<std::int64_t>();
    Term& term = listed.term;
    term.code = text_of(record, columns.code);
    term.label = text_of(record, columns.label);
    for (const auto& [language, column] : columns.labels)
      if (std::string label = text_of(record, column); !label.empty())
        term.labels[language] = std::move(label);
    term.definition = text_of(record, columns.definition);
    term.uri = text_of(record, columns.uri);
    term.color = clean_color(text_of(record, columns.color)).value_or("");
    term.pattern = text_of(record, columns.pattern);
    if (std::find(std::begin(kTermPatterns), std::end(kTermPatterns), term.pattern) ==
        std::end(kTermPatterns))
      term.pattern.clear();
    terms.emplace(listed.key, std::move(listed));
  }
  std::map<std::int64_t, std::vector<std::int64_t>> below;
  std::vector<std::int64_t> top;
  for (auto& [key, listed] : terms) {
    const auto parent = listed.parent ? terms.find(*listed.parent) : terms.end();
    if (parent == terms.end()) {
      top.push_back(key);
      continue;
    }
    listed.term.parent = parent->second.term.code;
    below[*listed.parent].push_back(key);
  }
  std::vector<ListedTerm> out;
  out.reserve(terms.size());
  std::set<std::int64_t> met;
  const auto write_down = [&](std::int64_t root) {
    std::vector<std::pair<std::int64_t, int>> open{{root, 0}};
    while (!open.empty()) {
      const auto [key, depth] = open.back();
      open.pop_back();
      if (!met.insert(key).second) continue;
      out.push_back(terms.at(key));
      out.back().depth = depth;
      const auto children = below.find(key);
      if (children == below.end()) continue;
      for (auto child = children->second.rbegin(); child != children->second.rend(); ++child)
        open.emplace_back(*child, depth + 1);
    }
  };
  for (const auto key : top) write_down(key);
  if (out.size() < terms.size())  // terms in cycles
    for (const auto& [key, listed] : terms)
      if (!met.contains(key)) write_down(key);
  return out;
}

std::string label_in(const Term& term, const std::string& language) {
  if (const std::string* label = find_label(term.labels, language)) return *label;
  if (!term.label.empty()) return term.label;
  return term.labels.empty() ? term.code : term.labels.begin()->second;
}

std::vector<bool> terms_with(std::span<const ListedTerm> terms, std::string_view text) {
  const auto words = words_of(search_text(text));
  std::vector<bool> out;
  out.reserve(terms.size());
  for (const ListedTerm& listed : terms) {
    std::string all = listed.term.code + "\n" + listed.term.label;
    for (const auto& [language, label] : listed.term.labels) all += "\n" + label;
    // The separate lines prevent a match that spans two texts.
    std::string folded;
    for (std::size_t begin = 0; begin <= all.size();) {
      const std::size_t end = std::min(all.find('\n', begin), all.size());
      folded += search_text(std::string_view(all).substr(begin, end - begin)) + "\n";
      begin = end + 1;
    }
    out.push_back(std::all_of(words.begin(), words.end(), [&](const std::string& word) {
      return folded.find(word) != std::string::npos;
    }));
  }
  return out;
}

Palette terms_palette(std::span<const ListedTerm> terms) {
  std::map<std::int64_t, Rgba> colors;
  std::map<std::int64_t, int> shades;  // number of shades of a term that its child terms use
  std::map<std::int64_t, Palette::Point> points;
  for (const ListedTerm& listed : terms) {  // parents come first
    const auto above = listed.parent ? colors.find(*listed.parent) : colors.end();
    Rgba color;
    if (!listed.term.color.empty())
      color = color_of_text(listed.term.color);
    else if (above != colors.end())
      color = shade(above->second, shades[*listed.parent]++);
    else
      color = generated_color(static_cast<std::uint32_t>(listed.key));
    colors[listed.key] = color;
    Palette::Point& point = points[listed.key];
    point = {static_cast<double>(listed.key), color, label_in(listed.term, {})};
    point.pattern = pattern_of(listed.term);
  }
  Palette palette;
  palette.mode = PaletteMode::categorical;
  for (auto& [key, point] : points) {
    if (palette.points.size() == kMaxTermColors) break;
    palette.points.push_back(std::move(point));
  }
  if (palette.points.empty()) return palette;
  palette.min = palette.points.front().at;
  palette.max = palette.points.back().at;
  return palette;
}

bool takes_term_colors(const Palette& palette) {
  return palette.mode == PaletteMode::categorical && palette.points.empty() &&
         palette.column.empty();
}

}  // namespace strata
