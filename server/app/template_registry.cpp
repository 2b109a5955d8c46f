#include "app/template_registry.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "core/text/slug.h"
#include "domain/tables/term_list.h"
#include "protocol/parse.h"
#include "store/tables/tables.h"

namespace strata::app {
namespace {

constexpr const char* kEnglish = "en";

std::string in_lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return text;
}

// The label of a language, or of the one that it is a kind of; null: there is none.
const std::string* label_of(const std::optional<protocol::Labels>& labels,
                            const std::optional<std::string>& language) {
  if (!labels || !language) return nullptr;
  for (std::string tag = in_lower_case(*language); !tag.empty();
       tag.resize(tag.find('-') == std::string::npos ? 0 : tag.rfind('-')))
    for (const auto& [known, label] : *labels)
      if (in_lower_case(known) == tag) return &label;
  return nullptr;
}

Result<TermList> terms_of(const std::vector<protocol::TemplateTerm>& terms,
                          const std::optional<std::string>& language) {
  TermList list;
  list.rows = terms.size();
  list.columns = {"code", "parent", "label", "definition", "color", "pattern"};
  std::set<std::string> codes;
  for (const protocol::TemplateTerm& told : terms) {
    Term term;
    term.code = told.code;
    term.parent = told.parent.value_or("");
    term.label = name_in(told.label, told.labels, language);
    for (const auto& [tag, label] : labels_with(told.label, told.labels)) {
      const std::string known = in_lower_case(tag);
      list.columns.insert(label_slug(known));
      term.labels[known] = label;
    }
    term.definition = told.definition;
    term.color = told.color.value_or("");
    if (told.pattern) term.pattern = protocol::name(*told.pattern);
    STRATA_TRY(check_term(term));
    if (!codes.insert(term.code).second)
      return fail(ErrorCode::invalid, "Code twice",
                  "The code " + term.code + " stands there twice.");
    // Those below come later, so that there can be no circle.
    if (!term.parent.empty() && !codes.contains(term.parent))
      return fail(ErrorCode::invalid, "No such parent",
                  term.code + " is below " + term.parent + ", which does not stand before it.");
    list.terms.push_back(std::move(term));
  }
  return list;
}

std::string slug_of_column(const protocol::ColumnCreate& column) {
  return column.slug.value_or(make_slug(column.name));
}

Result<Column> column_of(const protocol::ColumnCreate& told,
                         const std::optional<std::string>& language) {
  Column column;
  column.name = name_in(told.name, told.labels, language);
  column.slug = slug_of_column(told);
  column.labels = labels_with(told.name, told.labels);
  column.kind = *parse_column_kind(protocol::name(told.kind));
  column.unit = told.unit;
  column.required = told.required;
  column.unique = told.unique;
  if (told.default_value) column.default_value = *told.default_value;
  column.comment = told.comment;
  if (told.choices) column.choices = *told.choices;
  column.minimum = told.minimum;
  column.maximum = told.maximum;
  if (told.target) column.target = kOwnTable;  // until it is known which
  STRATA_TRY(check_column(column));
  return column;
}

Result<protocol::Template> read_template(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  auto read = STRATA_TRY(protocol::parse<protocol::Template>(text));
  read.slug = file.stem().string();
  if (make_slug(*read.slug) != *read.slug)
    return fail(ErrorCode::invalid, "Bad name",
                "Its name must be of lower-case letters, digits and hyphens.");
  STRATA_TRY(new_tables(read, 1, {}));
  for (const protocol::TemplateLayer& layer : read.layers)
    if (std::none_of(read.tables.begin(), read.tables.end(),
                     [&](const auto& table) { return table.slug == layer.table; }))
      return fail(ErrorCode::invalid, "No such table",
                  "The layer " + layer.name + " is of a table that is not there.");
  return read;
}

}  // namespace

Result<TemplateRegistry> TemplateRegistry::load(const std::filesystem::path& folder) {
  TemplateRegistry shelf;
  if (folder.empty()) return shelf;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    if (entry.path().extension() != ".json") continue;
    auto read = read_template(entry.path());
    if (!read)
      return fail(ErrorCode::internal, "Template not usable",
                  entry.path().string() + ": " +
                      (read.error().field.empty() ? "" : read.error().field + ": ") +
                      read.error().detail);
    shelf.templates_.push_back(std::move(*read));
  }
  if (error)
    return fail(ErrorCode::internal, "Templates not found",
                "The folder " + folder.string() + " cannot be read: " + error.message() + ".");
  std::sort(shelf.templates_.begin(), shelf.templates_.end(), [](const auto& a, const auto& b) {
    return std::tie(a.name, a.slug) < std::tie(b.name, b.slug);
  });
  return shelf;
}

const protocol::Template* TemplateRegistry::find(const std::string& slug) const {
  for (const protocol::Template& each : templates_)
    if (each.slug == slug) return &each;
  return nullptr;
}

std::string name_in(const std::string& name, const std::optional<protocol::Labels>& labels,
                    const std::optional<std::string>& language) {
  const std::string* label = label_of(labels, language);
  return label ? *label : name;
}

Labels labels_with(const std::string& name, const std::optional<protocol::Labels>& labels) {
  Labels all = labels.value_or(Labels());
  all.emplace(kEnglish, name);
  return all;
}

Result<std::vector<store::NewTable>> new_tables(const protocol::Template& of, ProjectId project_id,
                                                const std::optional<std::string>& language) {
  std::vector<store::NewTable> tables;
  for (const protocol::TemplateTable& told : of.tables) {
    const auto refuse = [&](const Error& problem) {
      return fail(problem.code, problem.title, told.slug + ": " + problem.detail, problem.field);
    };
    if (told.terms.has_value() == told.columns.has_value())
      return refuse({ErrorCode::invalid, "Terms or columns",
                     "A table has either `terms` or `columns`.", "tables"});
    store::NewTable made;
    made.table.project_id = project_id;
    made.table.name = name_in(told.name, told.labels, language);
    made.table.slug = told.slug;
    made.table.labels = labels_with(told.name, told.labels);
    made.table.description = told.description;
    if (told.terms) {
      auto terms = terms_of(*told.terms, language);
      if (!terms) return refuse(terms.error());
      std::vector<std::string> languages;
      for (const std::string& slug : terms->columns)
        if (const auto known = label_language(slug)) languages.push_back(*known);
      made.table.columns = new_term_columns(languages);
      made.terms = std::move(*terms);
    } else {
      std::set<std::string> slugs;
      for (const protocol::ColumnCreate& column : *told.columns) {
        auto fits = column_of(column, language);
        if (!fits) return refuse(fits.error());
        if (!slugs.insert(fits->slug).second)
          return refuse(
              {ErrorCode::invalid, "Slug twice", "Two columns are " + fits->slug + ".", {}});
        if (column.target && protocol::to_ref(*column.target) != told.slug) {
          const auto place = std::find_if(
              of.tables.begin(), of.tables.begin() + static_cast<std::ptrdiff_t>(tables.size()),
              [&](const auto& other) { return other.slug == protocol::to_ref(*column.target); });
          if (place == of.tables.begin() + static_cast<std::ptrdiff_t>(tables.size()))
            return refuse({ErrorCode::invalid,
                           "No such table",
                           column.name + " names records of a table that does not stand before it.",
                           {}});
          made.targets[made.table.columns.size()] =
              static_cast<std::size_t>(place - of.tables.begin());
        }
        made.table.columns.push_back(std::move(*fits));
      }
    }
    tables.push_back(std::move(made));
  }
  return tables;
}

}  // namespace strata::app
