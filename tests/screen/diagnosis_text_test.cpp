#include "screen/diagnosis_text.hpp"

#include <gmock/gmock.h>

#include "prowl/task_file/task_file.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

TEST(DiagnosisText, DoubtsNothingThatIsCertain) {
  const Task task = parse_task({"task.toml", test::kTaskFile}, {"hyq.toml", test::kHyqFile}, test::test_search());
  Diagnosis diagnosis;
  diagnosis.reasons = {"goal 1, phase 'stand': all 4 contacts are out of reach, by 0.16 m or more"};
  diagnosis.hints = {"goal 1, phase 'stand': no posture found that has the 4 contacts",
                     "goal 2, phase 'stand': no posture found that has the 4 contacts"};
  const std::string text = diagnosis_text(diagnosis, task.problem);
  EXPECT_THAT(text, AllOf(HasSubstr("  certain      goal 1, phase 'stand': all 4"), HasSubstr("  doubtful     goal 2"),
                          Not(HasSubstr("  doubtful     goal 1"))));
  diagnosis.reasons.clear();
  EXPECT_THAT(diagnosis_text(diagnosis, task.problem), HasSubstr("  doubtful     goal 1"));
}

}  // namespace
}  // namespace prowl
