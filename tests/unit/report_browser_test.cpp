// The page in a browser, where Chromium is installed: the slider moves train and wheels, zooming one chart zooms the
// others, and nothing is reported as an error, by the page's content policy neither.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

#include "../folder_fixture.hpp"
#include "railtab/runtime/measures/track_mean.hpp"
#include "report_page.hpp"
#include "report_run.hpp"

namespace railtab::report {
namespace {

std::string output_of(const std::string& command) {
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return "";
  std::string text;
  std::array<char, 65536> buffer;
  for (std::size_t n; (n = fread(buffer.data(), 1, buffer.size(), pipe)) > 0;) text.append(buffer.data(), n);
  pclose(pipe);
  return text;
}

class ReportInBrowser : public testing::InFolder {
 protected:
  void SetUp() override {
    InFolder::SetUp();
    browser_ = output_of("command -v chromium || command -v chromium-browser || command -v google-chrome");
    if (browser_.empty()) GTEST_SKIP() << "needs chromium, chromium-browser or google-chrome";
    browser_.pop_back();
  }

  /// What `script`, the body of a function, returns in the page after it has loaded, and then all errors.
  [[nodiscard]] std::string result(std::string page, const std::string& script) const {
    const std::string begin =
        "<script>const errors=[];window.addEventListener('error',e=>errors.push(e.message));"
        "document.addEventListener('securitypolicyviolation',e=>errors.push('policy: '+e.violatedDirective));"
        "console.error=(...a)=>errors.push(a.join(' '));</script>";
    page.insert(page.find("<title>"), begin);
    page.insert(page.rfind("</body>"),
                "<script>window.addEventListener('load',()=>setTimeout(()=>{let r;try{r=(()=>{" + script +
                    "})()}catch(e){r='exception: '+e}document.body.textContent='RESULT '+r+'; errors: '+"
                    "errors.join(', ')+' END'},500))</script>");
    const std::filesystem::path file = write("page.html", page);
    const std::string text = output_of("HOME='" + folder_.string() + "' timeout 60 '" + browser_ +
                                       "' --headless=new --no-sandbox --disable-gpu --window-size=1280,2400 "
                                       "--virtual-time-budget=5000 --dump-dom 'file://" +
                                       file.string() + "' 2>/dev/null");
    const std::size_t at = text.rfind("RESULT "), end = text.rfind(" END");
    return at == std::string::npos || end < at ? "no result: " + text.substr(0, 300) : text.substr(at, end - at);
  }

  std::string browser_;
};

TEST_F(ReportInBrowser, SliderMovesTheTrainAndTheWheels) {
  const std::string script = R"js(
const train = document.getElementById('train-canvas'), wheel = document.getElementById('wheel-canvas');
const before = [train.toDataURL(), wheel.toDataURL(), document.getElementById('clock').textContent];
const slider = document.getElementById('instant');
slider.value = Math.round(0.6 * slider.max); slider.dispatchEvent(new Event('input'));
const after = [train.toDataURL(), wheel.toDataURL(), document.getElementById('clock').textContent];
const changed = before.map((b, i) => b !== after[i]);
const select = document.getElementById('wheelset');
select.value = 1; select.dispatchEvent(new Event('change'));
const reading = document.querySelector('.reading').textContent;
return changed.join(' ') + '; ' + after[2] + '; ' + reading;
)js";
  const std::string text = result(report_page(long_run(1001, 8)), script);  // 1001 instants in 5 s; 0.6 of them: 3 s
  EXPECT_NE(text.find("RESULT true true true; t = 3.000 s, x = 30.0 m"), std::string::npos) << text;
  EXPECT_NE(text.find("Wheelset 2: left Q"), std::string::npos) << text;
  EXPECT_NE(text.find("by the table; right Q"), std::string::npos) << text;            // wheel 2
  EXPECT_NE(text.find("by the online search.; errors: "), std::string::npos) << text;  // wheel 3
  EXPECT_TRUE(text.ends_with("errors: ")) << text;
}

TEST_F(ReportInBrowser, ChartsZoomAndPointTogetherAndChannelsAreChosen) {
  const std::string script = R"js(
const open = railtab.charts.filter(c => c.graph), wheels = open.filter(c => c.over === 'position');
const full = wheels[0].graph.xAxisRange();
wheels[0].zoom(0.5);
const half = wheels.filter(c => !c.stale).map(c => c.graph.xAxisRange());  // what is far from the screen follows later
const width = half.map(r => ((r[1] - r[0]) / (full[1] - full[0])).toFixed(3));
wheels[1].frame.dispatchEvent(new KeyboardEvent('keydown', {key: '0', bubbles: true}));
const again = wheels[0].graph.xAxisRange();
const chart = wheels[0], count = chart.graph.numColumns();
chart.figure.querySelector('details').open = true;
chart.figure.querySelector('details').dispatchEvent(new Event('toggle'));
const boxes = chart.figure.querySelectorAll('.choice input');
boxes[3].checked = true; boxes[3].dispatchEvent(new Event('change'));
const over = document.getElementById('wheels-over');
over.value = 'time'; over.dispatchEvent(new Event('change'));
const time = wheels[0].graph.xAxisRange();
const line = wheels[0].lines[0], j = 400;
return half.length > 1 ? new Set(width).size + ' ' + width[0] + ' ' + (again[0] === full[0] && again[1] === full[1]) +
  ' ' + (chart.graph.numColumns() - count) + ' ' + time.map(t => t.toFixed(2)).join('-') + ' ' + line.at(2.0, 'time') :
  'no charts';
)js";
  const RunResults run = long_run(1001, 8);
  const std::string text = result(report_page(run), script);
  // the first chart is the mean over 2 m of wheel 1
  TrackMean mean(2.0);
  std::optional<double> expected;
  for (std::size_t i = 0; i <= 400; ++i) {
    const WheelRecord& wheel = run.steps[i].wheels[0];
    expected = mean.add(run.steps[i].position, wheel.Y / wheel.Q);
  }
  EXPECT_NE(text.find("RESULT 1 0.500 true 1 0.00-5.00 "), std::string::npos) << text;
  const std::size_t value = text.rfind(' ', text.find("; errors"));
  EXPECT_NEAR(std::stod(text.substr(value)), std::abs(expected.value()), 7e-5)
      << text;  // four digits of a value that is stored in steps
  EXPECT_TRUE(text.ends_with("errors: ")) << text;
}

TEST_F(ReportInBrowser, ComparisonOpensWithoutErrors) {
  const std::array<RunResults, 2> runs{long_run(600, 4), long_run(500, 4)};
  const std::string text =
      result(comparison_page(runs, {"a", "b"}),
             "return railtab.charts.filter(c => c.graph).length > 2 && railtab.charts[0].chosen().length;");
  EXPECT_TRUE(text.starts_with("RESULT 4;")) << text;
  EXPECT_TRUE(text.ends_with("errors: ")) << text;
}

}  // namespace
}  // namespace railtab::report
