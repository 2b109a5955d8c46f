#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "app/layers/feature_set.h"
#include "net/api/linked/linked_addresses.h"
#include "net/api/linked/scene_frame.h"
#include "store/content/comments.h"

namespace strata::net {

// A feature of a layer (app/layers/layer_features.h) with its table. Its coordinates are world
// coordinates in the order x, y, z.
struct AnnotatedFeature {
  const Model& model;
  const Layer& layer;
  const app::FeatureTable& table;
  const app::Feature& feature;
};

// Returns the name of the annotation in its layer: "areas.3", "lines_cracks.12-1".
std::string annotation_name(const app::FeatureTable& table, const app::Feature& feature);

// Return annotations with the terms of `web_annotation()`, without `@context`. The target is a part
// of the scene in the manifest of the model. A feature describes the record, if it has one. A reply
// annotates the first comment of its thread. `author` is empty if the caller must not see it.
nlohmann::json feature_annotation(const LinkedAddresses& addresses, const SceneFrame& frame,
                                  const AnnotatedFeature& annotated);
nlohmann::json comment_annotation(const LinkedAddresses& addresses, const SceneFrame& frame,
                                  const store::Comment& comment, const std::string& author);

}  // namespace strata::net
