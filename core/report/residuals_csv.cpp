#include "core/report/residuals_csv.h"

#include "core/report/csv_text.h"

#include <fmt/format.h>

#include <iterator>

namespace evical {

void residualsCsv(const NamedResult& named, std::span<const CircleResidual> residuals, const TextSink& sink) {
  std::string text =
      "camera,view,circle,time_s,x_px,y_px,residual_x_px,residual_y_px,sigma_x_px,sigma_y_px,used\n";
  constexpr std::size_t kPiece_bytes = 1 << 16;
  for (const CircleResidual& r : residuals) {
    fmt::format_to(std::back_inserter(text), "{},{},{},{},{},{},{},{},{},{},{}\n",
                   csvWord(named.cameras.at(static_cast<std::size_t>(r.camera)).name), r.view, r.circle,
                   r.time_s, r.centre_px.x(), r.centre_px.y(), r.residual_px.x(), r.residual_px.y(),
                   r.sigma_px.x(), r.sigma_px.y(), r.used ? 1 : 0);
    if (text.size() < kPiece_bytes) continue;
    sink(text);
    text.clear();
  }
  sink(text);
}

}  // namespace evical
