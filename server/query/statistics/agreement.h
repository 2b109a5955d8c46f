#pragma once

#include <optional>
#include <vector>

#include "query/statistics/cross_table.h"

namespace strata {
struct Layer;
}  // namespace strata

namespace strata::query {

// The agreement of two layers about one class. The class without a key is "not painted".
struct ClassAgreement {
  CrossTable::Key key;
  double both_m2 = 0;                  // where both layers have the class
  double first_m2 = 0, second_m2 = 0;  // where one layer has it, alone or with the other

  double iou() const;  // intersection over union (Jaccard 1912)
  double f1() const;   // twice the intersection over the sum of both (Dice 1945)
};

// The agreement of two observers who mapped the same surface, weighted by true surface area.
struct Agreement {
  double area_m2 = 0;   // the compared area
  double observed = 0;  // the share of this area where both layers have the same class
  double expected = 0;  // the same share for layers that are independent of each other
  // Cohen's kappa, (observed - expected) / (1 - expected), from -1 to 1 (Cohen 1960). Empty if both
  // layers have the same single class everywhere.
  std::optional<double> kappa;
  // Like `observed`, for the area where at least one layer is painted. Empty if both layers are
  // unpainted.
  std::optional<double> observed_painted;
  // The classes with an area in either layer, in ascending order of their keys; "not painted" last.
  std::vector<ClassAgreement> classes;
};

// Returns whether equal keys of the two layers mean the same class. This is true for layers of
// records of the same table, and for categorical palettes in which no key has two different names.
// If both palettes list keys, they must also have a key in common.
bool share_classes(const Layer& first, const Layer& second);

// Compares the rows (the first layer) with the columns (the second layer). "Not painted" is a class
// of its own, and the compared area includes `neither_m2`. Without this area, the kappa of layers
// with a single class could never be positive: places with this class in neither layer would be
// missing. Returns nothing for a table without area.
std::optional<Agreement> measure_agreement(const CrossTable& table);

}  // namespace strata::query
