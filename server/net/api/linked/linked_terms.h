#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "vocabulary/linked_document.h"

// The terms of linked data that the server uses.
namespace strata::net {

// Linked Art 1.0 (https://linked.art/api/1.0/), a profile of CIDOC CRM 7.1, and classes of the CRM
// that it leaves out.
const LinkedContext& linked_art();
// Web Annotation (https://www.w3.org/TR/annotation-model/) with the selectors in three dimensions
// of IIIF Presentation 4.
const LinkedContext& web_annotation();
// DCAT 3 and SKOS.
const LinkedContext& catalog_terms();

// Concepts of the Art & Architecture Thesaurus by which programs recognize texts in Linked Art.
nlohmann::json aat_type(const char* number, const char* label);

// Returns a statement about an entity in Linked Art. `type` may be null.
nlohmann::json statement(const std::string& label, const std::string& content,
                         const nlohmann::json& type = nullptr);

}  // namespace strata::net
