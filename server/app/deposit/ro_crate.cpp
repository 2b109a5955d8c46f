#include <nlohmann/json.hpp>
#include <set>

#include "app/deposit/citation.h"
#include "app/deposit/deposit_parts.h"
#include "app/deposit/identifiers.h"
#include "core/text/markup.h"
#include "core/text/percent.h"
#include "core/text/timestamp.h"
#include "core/version.h"

// Source: RO-Crate Metadata Specification 1.1.3, https://w3id.org/ro/crate/1.1.
namespace strata::app {
namespace {

using nlohmann::json;
using protocol::DepositAgent, protocol::DepositRecord;

constexpr const char* kMetadataFile = "ro-crate-metadata.json";
constexpr const char* kPreviewFile = "ro-crate-preview.html";

// Identifiers are relative references, so special characters are encoded, but not `/`.
std::string id_of_path(const std::string& path) {
  std::string id;
  for (std::size_t at = 0; at <= path.size();) {
    const std::size_t end = std::min(path.find('/', at), path.size());
    id += percent_encode(path.substr(at, end - at));
    if (end < path.size()) id += '/';
    at = end + 1;
  }
  return id;
}

json refer_to(const std::string& id) { return {{"@id", id}}; }

// The graph of the crate.
class Graph {
 public:
  void add(json entity) {
    if (known_.insert(entity.at("@id").get<std::string>()).second)
      entities_.push_back(std::move(entity));
  }

  std::string organization(const std::string& name, const std::optional<std::string>& ror) {
    const std::string id = ror ? *ror : "#organization-" + percent_encode(name);
    add({{"@id", id}, {"@type", "Organization"}, {"name", name}});
    return id;
  }

  std::string agent(const DepositAgent& agent) {
    if (agent.kind != protocol::DepositAgentKind::person)
      return organization(agent.name, agent.ror);
    const std::string id = agent.orcid ? *agent.orcid : "#person-" + percent_encode(agent.name);
    json person{{"@id", id}, {"@type", "Person"}, {"name", agent.name}};
    if (agent.affiliations)
      for (const auto& affiliation : *agent.affiliations)
        person["affiliation"].push_back(refer_to(organization(affiliation.name, affiliation.ror)));
    add(std::move(person));
    return id;
  }

  std::string license(const std::string& uri) {
    const License* known = find_license(uri);
    json entity{
        {"@id", uri}, {"@type", "CreativeWork"}, {"name", known ? std::string(known->name) : uri}};
    if (known) entity["identifier"] = std::string(known->id);
    add(std::move(entity));
    return uri;
  }

  json take() { return std::move(entities_); }

 private:
  json entities_ = json::array();
  std::set<std::string> known_;
};

json file_entity(Graph& graph, const BagFile& file) {
  json entity{{"@id", id_of_path(file.path)},
              {"@type", "File"},
              {"name", file.description.empty() ? file.path : file.description},
              {"encodingFormat", file.media_type},
              {"contentSize", std::to_string(file.bytes)},
              {"sha256", file.sha256}};
  if (!file.license.empty() && is_license(file.license))
    entity["license"] = refer_to(graph.license(file.license));
  return entity;
}

json root_entity(Graph& graph, const Project& project, const DepositRecord& record) {
  json root = schema_org(record);
  json entity{{"@id", "./"},
              {"@type", "Dataset"},
              {"name", root.value("name", project.name)},
              {"description", root.value("description", project.name)},
              // The crate is a new edition, so its date is exact.
              {"datePublished", utc_text(std::chrono::system_clock::now())},
              {"hasPart", json::array()}};
  for (const char* member : {"version", "inLanguage", "keywords", "usageInfo"})
    if (root.contains(member)) entity[member] = root[member];
  if (record.doi) entity["identifier"] = "https://doi.org/" + *record.doi;
  if (record.creators)
    for (const DepositAgent& creator : *record.creators)
      entity["author"].push_back(refer_to(graph.agent(creator)));
  if (record.contributors)
    for (const auto& contributor : *record.contributors)
      entity["contributor"].push_back(refer_to(graph.agent(contributor.agent)));
  if (record.publisher)
    entity["publisher"] =
        refer_to(graph.organization(record.publisher->name, record.publisher->ror));
  if (record.rights)
    for (const auto& rights : *record.rights)
      if (rights.uri) entity["license"].push_back(refer_to(graph.license(*rights.uri)));
  if (record.funding)
    for (const auto& funding : *record.funding)
      entity["funder"].push_back(
          refer_to(graph.organization(funding.funder.name, funding.funder.ror)));
  entity["citation"] = citation_text(record);
  return entity;
}

json model_entity(Graph& graph, const Model& model, const std::vector<BagFile>& files) {
  const std::string folder = "models/" + model.slug + "/";
  json entity{{"@id", id_of_path(folder)},
              {"@type", "Dataset"},
              {"name", model.name},
              {"hasPart", json::array()}};
  if (!model.credit.empty()) entity["creditText"] = model.credit;
  if (!model.inventory_number.empty()) entity["identifier"] = model.inventory_number;
  if (is_license(model.rights_uri)) {
    const License* known = find_license(model.rights_uri);
    entity["license"] = refer_to(graph.license(known ? std::string(known->uri) : model.rights_uri));
  }
  if (!model.owner.empty())
    entity["copyrightHolder"] = refer_to(graph.organization(model.owner, std::nullopt));
  for (const BagFile& file : files)
    if (file.path.starts_with(folder)) entity["hasPart"].push_back(refer_to(id_of_path(file.path)));
  return entity;
}

std::string preview(const Project& project, const std::vector<BagFile>& files,
                    const DepositRecord& record) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>" +
      escaped_markup(project.name) + "</title>\n</head>\n<body>\n<h1>" +
      escaped_markup(project.name) + "</h1>\n<p>" + escaped_markup(citation_text(record)) +
      "</p>\n<p><a href=\"" + kMetadataFile + "\">Metadata (JSON-LD)</a></p>\n<table>\n" +
      "<tr><th>File</th><th>Content</th><th>Bytes</th></tr>\n";
  for (const BagFile& file : files)
    html += "<tr><td><a href=\"" + id_of_path(file.path) + "\">" + escaped_markup(file.path) +
            "</a></td><td>" + escaped_markup(file.description) + "</td><td>" +
            std::to_string(file.bytes) + "</td></tr>\n";
  return html + "</table>\n</body>\n</html>\n";
}

}  // namespace

Result<void> add_ro_crate(Bag& bag, const Project& project, const std::vector<Model>& models,
                          const DepositRecord& record) {
  Graph graph;
  graph.add({{"@id", kMetadataFile},
             {"@type", "CreativeWork"},
             {"conformsTo", refer_to("https://w3id.org/ro/crate/1.1")},
             {"about", refer_to("./")},
             {"sdPublisher", "Strata " + std::string(version())}});
  json root = root_entity(graph, project, record);
  json parts = json::array();
  for (const BagFile& file : bag.files()) {
    root["hasPart"].push_back(refer_to(id_of_path(file.path)));
    parts.push_back(file_entity(graph, file));
  }
  for (const Model& model : models) {
    root["hasPart"].push_back(refer_to(id_of_path("models/" + model.slug + "/")));
    parts.push_back(model_entity(graph, model, bag.files()));
  }
  graph.add(std::move(root));
  for (json& part : parts) graph.add(std::move(part));
  graph.add({{"@id", kPreviewFile}, {"@type", "CreativeWork"}, {"about", refer_to("./")}});
  const json crate{{"@context",
                    {"https://w3id.org/ro/crate/1.1/context",
                     {{"sha256", "https://w3id.org/ro/terms/workflow-run#sha256"}}}},
                   {"@graph", graph.take()}};
  const std::string html = preview(project, bag.files(), record);
  BagFile metadata, page;
  metadata.path = kMetadataFile;
  metadata.media_type = "application/ld+json";
  page.path = kPreviewFile;
  page.media_type = "text/html";
  STRATA_TRY(bag.add(std::move(metadata), crate.dump(1)));
  return bag.add(std::move(page), html);
}

}  // namespace strata::app
