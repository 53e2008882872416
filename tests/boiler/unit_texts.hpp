#pragma once

#include <string>
#include <vector>

/// Files that the story writes for itself.
namespace mpm::boiler {

/// The unit file `text` without its section `model:`; of its CVs only those named, where any are,
/// and then without `simulation:`, which speaks of the others too.
[[nodiscard]] std::string tags_alone(const std::string& text,
                                     const std::vector<std::string>& cvs = {});

/// The unit of `old_file` in which the channels of the CVs named are those of `new_file`, and all
/// others as they were. Throws StoryError.
[[nodiscard]] std::string with_channels_of(const std::string& old_file, const std::string& new_file,
                                           const std::vector<std::string>& cvs);

/// The test signals of one scenario file on the plant that another one hides.
[[nodiscard]] std::string test_on_changed_plant(const std::string& tests,
                                                const std::string& changed);

/// The unit of `file` with the MVs' operating point at `mvs`, as far as the test signals of
/// `scenario` about it stay within their limits.
[[nodiscard]] std::string resting_at(const std::string& file, const std::vector<double>& mvs,
                                     const std::string& scenario);

/// What a scenario file says of itself.
[[nodiscard]] std::string description_of(const std::string& scenario);

}  // namespace mpm::boiler
