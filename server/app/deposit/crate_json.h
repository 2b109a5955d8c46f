#pragma once

#include <nlohmann/json.hpp>

#include "domain/layers/layer.h"
#include "domain/scene/model.h"
#include "domain/scene/surface_image.h"
#include "domain/tables/table.h"
#include "store/content/comments.h"
#include "store/content/named_parts.h"
#include "store/content/photographs.h"

// The parts of a project as JSON in a deposit, and back. Parts refer to each other by the ids of
// the site that made the deposit. The readers throw nlohmann::json::exception for a text of another
// form, and std::domain_error for an unknown name.
namespace strata::app::crate {

nlohmann::json to_crate(const Model& model);
nlohmann::json to_crate(const SurfaceImage& image);
nlohmann::json to_crate(const Layer& layer);
nlohmann::json to_crate(const Table& table);
nlohmann::json to_crate(const store::Photograph& photograph);
nlohmann::json to_crate(const store::NamedPart& part);
nlohmann::json to_crate(const store::Comment& comment);

// Return the part with the ids of the other site, and without its files, times, versions and
// sequences.
Model model_of(const nlohmann::json& json);
SurfaceImage surface_image_of(const nlohmann::json& json);
Layer layer_of(const nlohmann::json& json);
Table table_of(const nlohmann::json& json);
store::Photograph photograph_of(const nlohmann::json& json);
store::NamedPart named_part_of(const nlohmann::json& json);
store::Comment comment_of(const nlohmann::json& json);

}  // namespace strata::app::crate
