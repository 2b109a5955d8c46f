#include "app/template_registry.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "core/text/ascii.h"
#include "core/text/slug.h"
#include "core/text/utf8.h"
#include "domain/layers/group_name.h"
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

// Returns the label in a language or in its base language. Returns null if there is no label.
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
  for (const protocol::TemplateTerm& template_term : terms) {
    Term term;
    term.code = template_term.code;
    term.parent = template_term.parent.value_or("");
    term.label = name_in(template_term.label, template_term.labels, language);
    for (const auto& [tag, label] : labels_with(template_term.label, template_term.labels)) {
      const std::string known = in_lower_case(tag);
      list.columns.insert(label_slug(known));
      term.labels[known] = label;
    }
    term.definition = template_term.definition;
    term.color = template_term.color.value_or("");
    if (template_term.pattern) term.pattern = protocol::name(*template_term.pattern);
    STRATA_TRY(check_term(term));
    if (!codes.insert(term.code).second)
      return fail(ErrorCode::invalid, "Duplicate code",
                  "The code " + term.code + " appears twice.");
    // A term must follow its parent, so cycles are impossible.
    if (!term.parent.empty() && !codes.contains(term.parent))
      return fail(ErrorCode::invalid, "Parent not found",
                  term.code + " has the parent " + term.parent + ", which must come before it.");
    list.terms.push_back(std::move(term));
  }
  return list;
}

std::string slug_of_column(const protocol::ColumnCreate& column) {
  return column.slug.value_or(make_slug(column.name));
}

Result<Column> column_of(const protocol::ColumnCreate& definition,
                         const std::optional<std::string>& language) {
  Column column;
  column.name = name_in(definition.name, definition.labels, language);
  column.slug = slug_of_column(definition);
  column.labels = labels_with(definition.name, definition.labels);
  column.kind = *parse_column_kind(protocol::name(definition.kind));
  column.unit = definition.unit;
  column.required = definition.required;
  column.unique = definition.unique;
  if (definition.default_value) column.default_value = *definition.default_value;
  column.comment = definition.comment;
  if (definition.choices) column.choices = *definition.choices;
  column.minimum = definition.minimum;
  column.maximum = definition.maximum;
  if (definition.target) column.target = kOwnTable;  // placeholder until the target table is found
  STRATA_TRY(check_column(column));
  return column;
}

Result<protocol::Template> read_template(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  auto read = STRATA_TRY(protocol::parse<protocol::Template>(text));
  read.slug = file.stem().string();
  if (make_slug(*read.slug) != *read.slug)
    return fail(ErrorCode::invalid, "Invalid name",
                "The name must consist of lower-case letters, digits and hyphens.");
  STRATA_TRY(new_tables(read, 1, {}));
  for (const protocol::TemplateLayer& layer : read.layers)
    if (std::none_of(read.tables.begin(), read.tables.end(),
                     [&](const auto& table) { return table.slug == layer.table; }))
      return fail(ErrorCode::invalid, "Table not found",
                  "The layer " + layer.name + " needs a table that the template does not contain.");
  if (read.group) {
    std::vector<std::string> names{read.group->name};
    for (const auto& [language, label] : read.group->labels.value_or(protocol::Labels()))
      names.push_back(label);
    for (const std::string& name : names)
      if (trimmed(name) != name || name.empty() || character_count(name) > kMaxGroupLength)
        return fail(ErrorCode::invalid, "Invalid group",
                    "The name of the group must be 1 to 60 characters long, without spaces at the "
                    "beginning or the end.",
                    "group");
  }
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
      return fail(ErrorCode::internal, "Template cannot be used",
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
  for (const protocol::TemplateTable& template_table : of.tables) {
    const auto refuse = [&](const Error& problem) {
      return fail(problem.code, problem.title, template_table.slug + ": " + problem.detail,
                  problem.field);
    };
    if (!template_table.terms && !template_table.columns)
      return refuse({ErrorCode::invalid, "Terms and columns missing",
                     "A table must have `terms`, `columns` or both.", "tables"});
    store::NewTable made;
    made.table.project_id = project_id;
    made.table.name = name_in(template_table.name, template_table.labels, language);
    made.table.slug = template_table.slug;
    made.table.labels = labels_with(template_table.name, template_table.labels);
    made.table.description = template_table.description;
    if (template_table.terms) {
      auto terms = terms_of(*template_table.terms, language);
      if (!terms) return refuse(terms.error());
      std::vector<std::string> languages;
      for (const std::string& slug : terms->columns)
        if (const auto known = label_language(slug)) languages.push_back(*known);
      made.table.columns = new_term_columns(languages);
      made.terms = std::move(*terms);
    }
    if (template_table.columns) {
      std::set<std::string> slugs;
      for (const Column& column : made.table.columns) slugs.insert(column.slug);
      for (const protocol::ColumnCreate& column : *template_table.columns) {
        auto fits = column_of(column, language);
        if (!fits) return refuse(fits.error());
        if (!slugs.insert(fits->slug).second)
          return refuse({ErrorCode::invalid,
                         "Duplicate slug",
                         "Two columns have the slug " + fits->slug + ".",
                         {}});
        if (column.target && protocol::to_ref(*column.target) != template_table.slug) {
          const auto place = std::find_if(
              of.tables.begin(), of.tables.begin() + static_cast<std::ptrdiff_t>(tables.size()),
              [&](const auto& other) { return other.slug == protocol::to_ref(*column.target); });
          if (place == of.tables.begin() + static_cast<std::ptrdiff_t>(tables.size()))
            return refuse({ErrorCode::invalid,
                           "Table not found",
                           column.name + " refers to a table that must come before it.",
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
