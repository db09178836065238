// Time stamps of an IMU: sorted, without those of second clocks. Stamps that are coarser than the samples are
// apart are reconstructed (docs/maths.md, 8.1).
#pragma once

#include "core/base/option_row.h"
#include "core/data/imu_sample.h"
#include "core/data/recording.h"

#include <cstdint>
#include <string>
#include <vector>

namespace evical {

struct StampOptions {
  double finest_step_ms;
  double share_on_grid;
  double share_of_equal;
  double share_of_bends;
  double share_of_copies;
  double beat_scatter;
  double beat_share;
  double max_beat;
  double gap_periods;
  double lost_periods;

  StampOptions();  // the defaults
  constexpr explicit StampOptions(NoDefaults) {}
  bool operator==(const StampOptions&) const = default;
  static const OptionTable<StampOptions>& table();
};

struct CoarseStamps {
  double step_s = 0.0;  // 0: stamps are not coarse
  bool reconstructed =
      false;  // false: samples were not measured at a steady rate, so that their stamps are better
};

// Coarse stamps are rounded, of a clock with coarse ticks, or of groups of samples with one stamp each.
// Stamps that are exactly one period apart are not coarse. Replaces coarse ones by times of a rate that is as
// steady as they allow: no time is further than half a step from its stamp. Whether stamps were rounded down,
// up or to the nearest step remains unknown. Expects order of time.
CoarseStamps reconstructStamps(std::vector<ImuSample>& samples, const StampOptions& options = {});
RecordingFault faultOf(const std::string& stream, const CoarseStamps& stamps);

// Removes samples of second clocks and repeated stamps, sorts the others, and reconstructs coarse stamps.
// Returns the step of coarse stamps, and appends what was done to `faults`. `first_ns`: first time of the
// stream.
double putInOrder(const std::string& stream, std::int64_t first_ns, std::vector<ImuSample>& samples,
                  std::vector<RecordingFault>& faults, const StampOptions& options = {});

}  // namespace evical
