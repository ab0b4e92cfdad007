#pragma once
// The report: results folders in, one page out that needs nothing else to be read.

#include <map>
#include <string>
#include <vector>

#include "report/html/plot.h"
#include "results/folder.h"

namespace lodbench::report::html {

struct Report {
    std::string html;
    std::map<std::string, std::string> csv;  ///< every table, by its name
    std::vector<Plot> plots;                 ///< that the page shows
};

/// A pure function of the folders and of the pictures in them. Throws EnvironmentError where a
/// picture that is there cannot be read.
[[nodiscard]] Report make_report(const std::vector<results::ResultFolder>& folders);

}  // namespace lodbench::report::html
