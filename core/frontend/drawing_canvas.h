// Lines and text in sensor pixels on an enlarged picture of the sensor. Only stage_drawing.cpp includes this.
#pragma once

#include "core/frontend/rgb_image.h"

#include "core/geometry/resolution.h"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <string>
#include <vector>

namespace evical {

struct Colour {
  std::uint8_t r, g, b;
};

class DrawingCanvas {
 public:
  DrawingCanvas(Resolution resolution_px, int wanted_width_px);

  int factor() const { return factor_; }

  // Brightness 0..1 of the colour; a pixel that is drawn twice keeps the brighter one.
  void pixel(int x_px, int y_px, Colour colour, double brightness);
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Colour colour, int thickness = 1);
  void arrow(const Eigen::Vector2d& from, const Eigen::Vector2d& to, Colour colour);
  void circle(const Eigen::Vector2d& centre, double radius_px, Colour colour, int thickness = 1);
  void outline(const std::vector<Eigen::Vector2d>& points, Colour colour, int thickness = 1);  // closed
  void cross(const Eigen::Vector2d& centre, Colour colour);
  void label(const Eigen::Vector2d& beside, const std::string& text, Colour colour);

  // One line above the picture and one below: coloured words. Call it last: they cover drawings outside the
  // picture.
  void title(const std::string& text);
  void legend(const std::vector<std::pair<std::string, Colour>>& words);

  RgbImage image() const;

 private:
  cv::Point fixed(const Eigen::Vector2d& pixel) const;  // with kShift fractional bits

  int factor_;
  cv::Mat canvas_;
};

}  // namespace evical
