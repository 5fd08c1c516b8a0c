#include "coordinator/scenario/load_prices.h"

#include <vector>

#include "coordinator/scenario/read_text.h"
#include "coordinator/scenario/yaml_reader.h"

namespace tcs {

namespace {

PriceBySize LoadPrice(const YamlMap& map, const char* key) {
  const char* example = "[20us, 22us, 60us, 700us]";
  const YamlValue& value = map.Require(key, std::string(key) + ": " + example);
  const std::vector<YamlValue> values = value.AsList(example);
  PriceBySize::Times times;
  if (values.size() != times.size()) {
    value.Fail("has to be four durations, for samples of 0, 1024, 65536 and 1048576 bytes, as in " +
               std::string(example));
  }
  for (std::size_t i = 0; i < times.size(); ++i) times[i] = values[i].AsDuration();
  return PriceBySize(times);
}

DdsPrices LoadDdsPrices(const YamlMap& dds, const char* key) {
  const YamlMap map =
      dds.Require(key, std::string(key) + ": {send: …, send_further: …, receive: …}").AsMap();
  map.AllowOnly({"send", "send_further", "receive"});
  return {.send = LoadPrice(map, "send"),
          .send_further = LoadPrice(map, "send_further"),
          .receive = LoadPrice(map, "receive")};
}

PriceList LoadPrices(const std::string& path) {
  const YamlMap top =
      ParseYaml(path, ReadText(path, "a list of prices, or write none"), {}).AsMap();
  top.AllowOnly({"machine", "dds"});
  PriceList list = NoPrices();
  list.name = path;
  if (const YamlValue* machine = top.Find("machine")) list.name += " (" + machine->AsText() + ")";
  const YamlMap dds = top.Require("dds", "dds: {reliable: …, best_effort: …, computed: …}").AsMap();
  dds.AllowOnly({"reliable", "best_effort", "computed"});
  list.dds_reliable = LoadDdsPrices(dds, "reliable");
  list.dds_best_effort = LoadDdsPrices(dds, "best_effort");
  list.dds_computed = LoadDdsPrices(dds, "computed");
  return list;
}

}  // namespace

LoadResult<PriceList> LoadPriceFile(const std::string& path) {
  try {
    return LoadPrices(path);
  } catch (const ScenarioMistake& mistake) {
    return LoadError{mistake.message};
  }
}

}  // namespace tcs
