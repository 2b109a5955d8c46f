#include "net/api/linked/linked_catalog.h"

#include "vocabulary/rdf.h"

namespace strata::net {
namespace {

nlohmann::json distribution(const std::string& title, const std::string& address,
                            const char* format) {
  return {{"type", "Distribution"}, {"title", title}, {"access_url", address}, {"format", format}};
}

void add_text(nlohmann::json& json, const char* property, const std::string& text) {
  if (!text.empty()) json[property] = text;
}

nlohmann::json model_dataset(const LinkedAddresses& addresses, const Model& model) {
  nlohmann::json json{
      {"id", addresses.model(model.id)},
      {"type", "Dataset"},
      {"title", model.name},
      {"landing_page", addresses.page(model)},
      {"distribution",
       {distribution("IIIF manifest", addresses.manifest(model.id), "application/ld+json"),
        distribution("Annotations", addresses.annotations(model.id), "application/ld+json"),
        distribution("Collection for GIS programs", addresses.gis(model), "application/json")}}};
  add_text(json, "identifier", model.inventory_number);
  add_text(json, "rights", model.rights_uri);
  return json;
}

nlohmann::json table_dataset(const LinkedAddresses& addresses, const Table& table) {
  nlohmann::json json{
      {"id", addresses.table(table.id)},
      {"type", "Dataset"},
      {"title", table.name},
      {"distribution",
       {distribution("Records", addresses.api(table) + "/records?f=csv", "text/csv"),
        distribution("Records", addresses.api(table) + "/records?f=json", "application/json")}}};
  add_text(json, "description", table.description);
  return json;
}

}  // namespace

nlohmann::json linked_catalog(const LinkedAddresses& addresses, const std::vector<Model>& models,
                              const std::vector<Table>& tables) {
  nlohmann::json json{{"id", addresses.catalog()},
                      {"type", "Catalog"},
                      {"title", "Strata"},
                      {"description", "The models and tables of this site as linked data"},
                      {"dataset", nlohmann::json::array()}};
  for (const Model& model : models) json["dataset"].push_back(model_dataset(addresses, model));
  for (const Table& table : tables) json["dataset"].push_back(table_dataset(addresses, table));
  return json;
}

nlohmann::json linked_table(const LinkedAddresses& addresses, const Table& table,
                            std::span<const std::int64_t> keys) {
  nlohmann::json json = table_dataset(addresses, table);
  for (const std::int64_t key : keys) json["has_part"].push_back(addresses.record(table.id, key));
  return json;
}

nlohmann::json linked_term(const LinkedAddresses& addresses, const Table& table,
                           const ListedTerm& listed) {
  const std::string scheme = addresses.table(table.id);
  const Term& term = listed.term;
  nlohmann::json json{{"id", addresses.record(table.id, listed.key)},
                      {"type", "Concept"},
                      {"in_scheme", scheme},
                      {"notation", term.code}};
  nlohmann::json labels = nlohmann::json::array();
  if (!term.label.empty()) labels.push_back(term.label);
  for (const auto& [language, label] : term.labels)
    labels.push_back({{"@value", label}, {"@language", language}});
  if (!labels.empty()) json["preferred_label"] = std::move(labels);
  add_text(json, "definition", term.definition);
  if (is_iri(term.uri)) json["exact_match"] = term.uri;
  if (listed.parent)
    json["broader"] = addresses.record(table.id, *listed.parent);
  else
    json["top_concept_of"] = scheme;
  return json;
}

nlohmann::json linked_terms(const LinkedAddresses& addresses, const Table& table,
                            std::span<const ListedTerm> terms) {
  nlohmann::json json{{"id", addresses.table(table.id)},
                      {"type", {"ConceptScheme", "Dataset"}},
                      {"title", table.name},
                      {"preferred_label", table.name}};
  add_text(json, "description", table.description);
  for (const ListedTerm& listed : terms) {
    nlohmann::json term = linked_term(addresses, table, listed);
    if (!listed.parent) json["has_top_concept"].push_back(term.at("id"));
    json["has_part"].push_back(std::move(term));
  }
  return json;
}

}  // namespace strata::net
