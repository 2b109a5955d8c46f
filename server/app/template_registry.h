#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/ids.h"
#include "protocol/messages.h"
#include "store/store.h"
#include "store/tables/tables.h"

namespace strata::app {

// The templates that come with the server: `<slug>.json` in a folder, as the protocol's Template.
// Read once, at start.
class TemplateRegistry {
 public:
  // Refused (500), with the file's name: what is no Template, terms that cannot be in a list,
  // columns and layers of tables that it does not have. Without a folder (empty path) there are
  // none.
  static Result<TemplateRegistry> load(const std::filesystem::path& folder);

  const std::vector<protocol::Template>& all() const { return templates_; }  // by name
  const protocol::Template* find(const std::string& slug) const;             // null: there is none

 private:
  std::vector<protocol::Template> templates_;
};

// What a thing of a template is called in a language ("es", "es-MX"), otherwise by its English
// name.
std::string name_in(const std::string& name, const std::optional<protocol::Labels>& labels,
                    const std::optional<std::string>& language);

// All that a thing of a template is called, the English name among them.
Labels labels_with(const std::string& name, const std::optional<protocol::Labels>& labels);

// The template's tables as the store makes them, in a language. Slugs stay what they are in
// English, so that scripts work in any. Refused: what load() refuses.
Result<std::vector<store::NewTable>> new_tables(const protocol::Template& of, ProjectId project_id,
                                                const std::optional<std::string>& language);

}  // namespace strata::app
