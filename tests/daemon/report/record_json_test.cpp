#include "daemon/report/record_json.hpp"

#include <catch2/catch.hpp>

#include "tests/idl/fixed_records.hpp"

namespace mpm::report {
namespace {

// The lines as they are known to who reads journals, `mpm watch --json` or `mpm echo --json`. They
// were written down once; a change of them is a change of a public format.
TEST_CASE("records are the JSON lines that readers know, byte for byte") {
  using namespace test;
  AlarmRecord unnamed = diagnosed_alarm();
  unnamed.named.cause.reset();
  unnamed.named.parameters.clear();
  CHECK(json_of(mismatching_channel()).dump() ==
        R"({"record":"channel","unit":"shell","interval":4711,"time_ns":1714564800250000000,)"
        R"("mv":"FIC-101.SP","cv":"TI-7 °C","verdict":"mismatch","p_value":1.25e-12,)"
        R"("statistic":9.1,"threshold":3.3,"partial_correlation":-0.41,"lag":9,)"
        R"("excited":true,"p_value_material":0.03125,"material":true,"effect_size":1.2,)"
        R"("effect_interval":[0.7,1.7],"model_gain":-4.05,)"
        R"("gain_error_percent":-29.62962962962963,)"
        R"("gain_error_percent_interval":[-41.97530864197531,-17.283950617283953],)"
        R"("time_constant_ratio":1.5,"time_constant_ratio_interval":[1.1,2.25],)"
        R"("dead_time_error":-60.0,"dead_time_error_interval":[-90.5,-29.5],)"
        R"("smallest_error":0.08,"effective_samples":3999.5,"alarm":"active",)"
        R"("gain_variation":0.375,)"
        R"("nonlinear":{"verdict":"nonlinear","kind":"input_curve","p_value":2.5e-09,)"
        R"("statistic":4.5,"share":0.0625,"material":true,"smallest_variation":0.125},)"
        R"("partial_correlations":{"lags":[-2,1],"values":[0.01,-0.02,0.3,0.0]}})");
  CHECK(json_of(collinear_channel()).dump() ==
        R"({"record":"channel","unit":"shell","interval":12,"time_ns":12000000000,"mv":"u1",)"
        R"("cv":"y2","verdict":"undetermined","reason":"collinear with u3","p_value":0.5,)"
        R"("statistic":0.0,"threshold":0.0,"partial_correlation":0.0,"lag":0,"excited":false,)"
        R"("p_value_material":1.0,"material":false,"effect_size":0.0,"effect_interval":[0.0,)"
        R"(0.0],"model_gain":0.0,"smallest_error":0.0,"effective_samples":0.0,)"
        R"("alarm":"cleared","partial_correlations":{"lags":[1,1],"values":[0.25]}})");
  CHECK(json_of(alarm(AlarmChange::kActive)).dump() ==
        R"({"record":"alarm","unit":"shell","interval":812,"time_ns":812000000001,)"
        R"("mv":"FIC-101.SP","cv":"y1","to":"active","p_value":3e-09,"statistic":11.5,)"
        R"("threshold":3.5,"partial_correlation":0.625,"lag":4,"effect_size":-0.75})");
  CHECK(json_of(alarm(AlarmChange::kCleared)).dump() ==
        R"({"record":"alarm","unit":"shell","interval":812,"time_ns":812000000001,)"
        R"("mv":"FIC-101.SP","cv":"y1","to":"cleared","p_value":3e-09,"statistic":11.5,)"
        R"("threshold":3.5,"partial_correlation":0.625,"lag":4,"effect_size":-0.75})");
  CHECK(json_of(diagnosed_alarm()).dump() ==
        R"({"record":"diagnosis","unit":"shell","interval":812,"time_ns":812000000001,)"
        R"("mv":"FIC-101.SP","cv":"y1","to":"diagnosed","p_value":3e-09,"statistic":11.5,)"
        R"("threshold":3.5,"partial_correlation":0.625,"lag":4,"effect_size":-0.75,)"
        R"("cause":"dynamics","cause_text":"y1 answers FIC-101.SP late.",)"
        R"("cause_confidence":0.98,"cause_parameters":{"gain_ratio":0.75,)"
        R"("dead_time_error":60.0},"cause_intervals":{"gain_ratio":[0.72,0.78],)"
        R"("dead_time_error":[30.0,90.5]}})");
  CHECK(json_of(unnamed).dump() ==
        R"({"record":"diagnosis","unit":"shell","interval":812,"time_ns":812000000001,)"
        R"("mv":"FIC-101.SP","cv":"y1","to":"diagnosed","p_value":3e-09,"statistic":11.5,)"
        R"("threshold":3.5,"partial_correlation":0.625,"lag":4,"effect_size":-0.75,)"
        R"("cause":null,"cause_text":"y1 answers FIC-101.SP late.","cause_confidence":0.98,)"
        R"("cause_parameters":{},"cause_intervals":{}})");
  CHECK(json_of(AlarmStateRecord(diagnosed_alarm())).dump() ==
        R"({"record":"alarm","unit":"shell","interval":812,"time_ns":812000000001,)"
        R"("mv":"FIC-101.SP","cv":"y1","to":"active","p_value":3e-09,"statistic":11.5,)"
        R"("threshold":3.5,"partial_correlation":0.625,"lag":4,"effect_size":-0.75,)"
        R"("cause":"dynamics","cause_text":"y1 answers FIC-101.SP late.",)"
        R"("cause_confidence":0.98,"cause_parameters":{"gain_ratio":0.75,)"
        R"("dead_time_error":60.0},"cause_intervals":{"gain_ratio":[0.72,0.78],)"
        R"("dead_time_error":[30.0,90.5]},"alarm_state":"normal","acknowledged":true,)"
        R"("shelving_state":"unshelved","unshelve_time_ns":0,"suppressed":false,)"
        R"("suppressed_by_design":false,"out_of_service":false,"retain":false,)"
        R"("active_time_ns":0,"ack_time_ns":0,"client_user_id":"","comment":"",)"
        R"("notification_class":"alert","priority":"low","severity":0,"message":""})");
  CHECK(json_of(health()).dump() ==
        R"({"record":"health","unit":"shell","interval":99,"time_ns":99000000000,)"
        R"("state":"maintenance_required","detail":"2 alarms","frames":101,"used":102,)"
        R"("missing":103,"incomplete":104,"late":105,"repeated":106,"out_of_order":107,)"
        R"("bad_values":108,"wrong_length":109,"unknown_unit":110,"restarts":111,)"
        R"("undetermined":112,"matching":113,"mismatching":114,"active_alarms":115,)"
        R"("beyond":116,"silenced_alarms":117})");
  CHECK(json_of(performance()).dump() ==
        R"({"record":"performance","unit":"shell","interval":600,"time_ns":601000000000,)"
        R"("window_samples":28800,"samples":599,"service_factor":0.9375,"cvs":[{"cv":"y1",)"
        R"("unit":"degC","setpoint":"sp1","samples":598,"control_error":{"mean":-0.125,)"
        R"("variance":0.25,"rms":0.5156},"outside_limits":0.0625,"prediction":[{"samples":1,)"
        R"("rmse":0.1,"movement_rms":0.2},{"samples":90,"rmse":0.3,"movement_rms":0.7}]},)"
        R"({"cv":"y2","unit":"","setpoint":null,"samples":0,"control_error":null,)"
        R"("outside_limits":null,"prediction":[]}],"mvs":[{"mv":"u1","unit":"%",)"
        R"("samples":597,"at_low":0.01,"at_high":0.02,"at_limits":0.03,"travel":0.75,)"
        R"("standing":0.5},{"mv":"u2","unit":"","samples":0,"at_low":null,"at_high":null,)"
        R"("at_limits":null,"travel":null,"standing":null}]})");
}

}  // namespace
}  // namespace mpm::report
