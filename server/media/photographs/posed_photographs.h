#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "media/photographs/camera.h"

namespace strata::photo {

// Programs that export the cameras of photographs.
enum class PoseFormat { colmap, metashape, realitycapture, bundler };
inline constexpr std::array<std::string_view, 4> kPoseFormatNames{"colmap", "metashape",
                                                                  "realitycapture", "bundler"};
constexpr std::string_view name(PoseFormat format) {
  return kPoseFormatNames[static_cast<std::size_t>(format)];
}

constexpr std::size_t kMaxPosedPhotographs = 20'000;     // with those that have no pose
constexpr std::size_t kMaxPoseFileBytes = 16ull << 30;   // COLMAP and Bundler also list points
constexpr std::size_t kMaxPoseTextBytes = 256ull << 20;  // XML, CSV, and the list of Bundler
constexpr std::size_t kMaxPhotographName = 1024;         // bytes

// A file of an export, in memory or mapped (core/mapped_file.h). `name` is the user's name of the
// file, with or without folders.
struct PoseFile {
  std::string name;
  std::span<const std::uint8_t> bytes;
};

// A photograph whose pose is known. `name` is the name in the export: UTF-8 without control
// characters, with folders if the program writes them, and with `/` between them. Metashape and the
// XMP files of RealityCapture usually leave out the extension. Names can repeat, because cameras
// restart their numbers in another folder.
struct PosedPhotograph {
  std::string name;
  Calibration calibration;
  Pose pose;
};

// A photograph whose camera cannot be used, for example one with a fisheye lens of Metashape.
struct RefusedPhotograph {
  std::string name;
  Error reason;
};

struct PosedPhotographs {
  PoseFormat format = PoseFormat::colmap;
  std::vector<PosedPhotograph> photographs;  // in the order of the export, at least one
  std::vector<RefusedPhotograph> refused;
  std::size_t without_pose = 0;         // disabled or not aligned
  std::size_t in_other_components = 0;  // Metashape aligned them separately, without a common place
  // The coordinate system that the export names, as WKT; only Metashape.
  std::string coordinate_system;
  // The world coordinates are geocentric (EPSG:4978), because Metashape exports cameras with a
  // geographic or projected system like this. A model in other coordinates does not fit them.
  bool is_geocentric = false;
  std::vector<std::string> unused_files;  // names of files that the reader did not need
};

// Reads the cameras of photographs from the files of one export. The content of the files decides
// about the format:
// - COLMAP: cameras.txt and images.txt, or cameras.bin and images.bin. The binary files have no
//   signature, so their names decide. Source: https://colmap.github.io/format.html.
// - Metashape 1.5 to 2.x: the XML of "Export Cameras" of one chunk, with frame cameras. The
//   transformation of the component, or else of the chunk, leads to world coordinates. Photographs
//   of other components than the active one are left out, unless both have a transformation.
//   Source: Agisoft Metashape User Manual, "Camera models", and for the axes the answers of Agisoft
//   in https://www.agisoft.com/forum/index.php?topic=12982 and topic=6176.
// - RealityCapture and RealityScan: the CSV of "Internal/External camera parameters" with a row of
//   names, or an XMP file for each photograph. The CSV does not name the lens model: it is the
//   division model if only k1 differs from 0, and otherwise Brown's model. In a georeferenced
//   project, its angles refer to true north but its coordinates to the grid of the chosen system,
//   so only XMP files are exact there. Neither states the size of the photographs. Source: M.
//   Hornáček, "On the Coordinate Systems Employed in the Import, Estimation, and Export of Camera
//   Geometry by RealityScan" (2026), sections 3 to 5, appendix B.
// - Bundler v0.3: bundle.out and the list of the photographs. It does not state their size.
//   Source: Bundler v0.4 User's Manual, "Output format".
//
// Returns an `invalid` error for unreadable files, with the name of the file, the line if it is a
// text, and what to do: wrong numbers of values, numbers that are not finite, matrices that are not
// rotations, references to missing cameras, XML with a document type, several exports at once, and
// an export without any usable photograph. Returns `too_large` above the limits. A rotation may
// deviate from an exact one by 0.001, and is corrected. Does not keep the bytes. Thread-safe.
Result<PosedPhotographs> read_poses(std::span<const PoseFile> files);

}  // namespace strata::photo
