#include "core/report/residuals_csv.h"

#include "core/report/csv_text.h"

#include <fmt/format.h>

#include <iterator>

namespace evical {

std::string residualsCsv(const NamedResult& named, std::span<const CircleResidual> residuals) {
  std::string text =
      "camera,view,circle,time_s,x_px,y_px,residual_x_px,residual_y_px,sigma_x_px,sigma_y_px,used\n";
  for (const CircleResidual& r : residuals)
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{}\n",
                   csvWord(named.cameras.at(static_cast<std::size_t>(r.camera)).name), r.view, r.circle,
                   r.time_s, r.centre_px.x(), r.centre_px.y(), r.residual_px.x(), r.residual_px.y(),
                   r.sigma_px.x(), r.sigma_px.y(), r.used ? 1 : 0);
  return text;
}

}  // namespace evical
