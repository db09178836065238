// A square matrix of numbers between -1 and 1 as coloured cells, rows and columns named alike.
#pragma once

#include <Eigen/Core>

#include <string>
#include <vector>

namespace evical::html {

// Positive values get class "warm", negative ones "cold", the stronger the more opaque; each cell says its
// value when hovered over.
std::string heatMapSvg(const std::string& title, const std::vector<std::string>& names,
                       const Eigen::MatrixXd& values);

}  // namespace evical::html
