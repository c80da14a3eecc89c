#include "prowl/tracking/feedback_design.hpp"

namespace prowl {

int FeedbackDesign::num_samples() const {
  std::size_t samples = 0;
  for (const ReferencePhase& phase : phases) samples += phase.samples.size();
  return static_cast<int>(samples);
}

}  // namespace prowl
