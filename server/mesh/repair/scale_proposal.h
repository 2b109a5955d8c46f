#pragma once

#include "domain/scene/model.h"
#include "mesh/io/load.h"

namespace strata::mesh {

// Proposes the unit and the up direction of a file, with the reason. The proposal comes from the
// file's data or its shape:
//
// - the format: glTF is in meters with +Y up
// - a comment of the file, see stated_unit and stated_up
// - map coordinates (`crs`, or a position far from 0 compared to the extent): meters, +Z up
// - common coordinates of several scans, which come from a survey: +Z up
// - the size: the unit with which the model is as large as usual scanned objects (kSizes in
//   scale_proposal.cpp)
// - the shape: the pose in which the object would stand, see up_shares
//
// Reads each vertex a few times. Can be called on any thread.
ScaleProposal propose_scale(const LoadedMesh& loaded, const std::string& crs);

}  // namespace strata::mesh
