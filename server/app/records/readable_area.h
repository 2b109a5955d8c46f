#pragma once

#include <string>

// Areas in a unit that people read, where scripts have `area_m2`.
namespace strata::app {

struct AreaUnit {
  std::string name;  // "mm²"
  double per_m2 = 1;
};

// For areas up to this one: mm² below 1 cm², cm² below 0.1 m², as the page has it.
AreaUnit readable_area(double largest_m2);

// A number format of spreadsheets: four digits of the largest number, and two decimals at least.
std::string number_format(double largest);

// "area_m2" → "area (mm²)", "model/layer area_m2" → "model/layer area (mm²)".
std::string readable_head(const std::string& head, const AreaUnit& unit);

}  // namespace strata::app
