//! The cost of a layer, where a scene was drawn with several numbers of layers.

use super::data::{MethodSeries, ShownScene};
use crate::chart::key;
use crate::numbers::{between, round_duration};
use crate::page::adapter::breakable;
use crate::table::{Cell, Table};
use etalon_record::Cost;
use maud::{Markup, html};

/// The parameter that counts layers.
const LAYERS: &str = "layers";

/// Seconds of a layer for each megapixel, between the fewest and the most layers that were timed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LayerCost {
    layers: [f64; 2],
    seconds: f64,
    /// From the ends of both intervals, so it holds with 90 % confidence or more; `None` if one has no interval.
    interval: Option<[f64; 2]>,
    /// False if a number between them is farther from the line than [`Cost::STRAIGHT`].
    is_straight: bool,
}

impl LayerCost {
    /// Returns the cost along a series on an adapter; `None` unless two numbers of layers have a cost.
    fn of(series: &MethodSeries<'_>, adapter: usize) -> Option<Self> {
        let timed = series.on(adapter).filter_map(|point| {
            let cost = point.measured.cost.filter(|cost| !cost.is_crooked())?;
            Some((point.value?, cost.per_megapixel))
        });
        let timed: Vec<_> = timed.collect();
        let ((few, least), (many, most)) = (timed.first()?, timed.last()?);
        let more = many - few;
        if more <= 0.0 {
            return None;
        }
        let seconds = (most.median - least.median) / more;
        let line = |layers: f64| least.median + seconds * (layers - few);
        let is_straight = timed.iter().all(|(layers, cost)| {
            (line(*layers) - cost.median).abs() <= Cost::STRAIGHT * cost.median.abs()
        });
        let ends = least.interval.zip(most.interval);
        Some(Self {
            layers: [*few, *many],
            seconds,
            interval: ends.map(|(least, most)| [0, 1].map(|i| (most[i] - least[1 - i]) / more)),
            is_straight,
        })
    }

    fn cell(&self) -> Cell {
        Cell::from(html! {
            (round_duration(self.seconds.max(0.0)))
            @if let Some(interval) = self.interval {
                br; small { (between(interval.map(|end| end.max(0.0)), round_duration)) }
            }
            @if !self.is_straight { br; small { "not in proportion" } }
        })
    }
}

/// Returns the table of a scene, a row for each method and a column for each adapter; `None` without a cost.
pub(super) fn section(shown: &ShownScene<'_, '_>) -> Option<Markup> {
    let has_layers = |s: &&MethodSeries<'_>| s.parameter == Some(LAYERS);
    let adapters = 0..shown.methods.adapters.len();
    let has_cost = |s: &&MethodSeries<'_>| adapters.clone().any(|a| LayerCost::of(s, a).is_some());
    let series: Vec<&MethodSeries<'_>> = shown
        .scene
        .series
        .iter()
        .filter(has_layers)
        .filter(has_cost)
        .collect();
    let costs = || {
        series
            .iter()
            .flat_map(|s| adapters.clone().filter_map(|a| LayerCost::of(s, a)))
    };
    let fewest = costs().map(|cost| cost.layers[0]).reduce(f64::min)?;
    let most = costs().map(|cost| cost.layers[1]).reduce(f64::max)?;
    let mut table = Table::<&MethodSeries<'_>>::new("numbers").head("Method", |series| {
        Cell::from(html! { (key(shown.style(series.method))) " " (series.name()) })
    });
    for adapter in adapters.clone() {
        if series.iter().all(|s| LayerCost::of(s, adapter).is_none()) {
            continue;
        }
        let name = breakable(shown.methods.adapters[adapter].name);
        table = table.text(name, move |series| {
            LayerCost::of(series, adapter).map(|cost| cost.cell())
        });
    }
    Some(html! {
        details {
            summary { "What a layer costs" }
            p.cap {
                "Time of one more layer for each megapixel, from " (fewest) " to " (most) " layers, with an interval of at "
                "least 90 % confidence. Not in proportion: a number of layers between them is more than 10 % off the line."
            }
            (table.page(series.iter().copied()))
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::Methods;
    use crate::methods::tests::made::{Made, run};
    use etalon_record::{Clock, Estimate, Run};

    /// Returns a run over numbers of layers, each with its milliseconds for a megapixel.
    fn layered(costs: &[(f64, f64)]) -> Run {
        let made =
            |layers: f64| Made::new("transparency/thin-layers/method=sorted").at(LAYERS, layers);
        let mut run = run(&costs
            .iter()
            .map(|(layers, _)| made(*layers))
            .collect::<Vec<_>>());
        for (record, (_, time)) in run.records.iter_mut().zip(costs) {
            let estimate = |median: f64, by: f64| Estimate {
                median,
                interval: Some([median - by, median + by]),
            };
            let measured = record.measured.as_mut().unwrap();
            measured.cost = Some(Cost {
                clock: Clock::Wall,
                fixed: estimate(0.0, 0.0),
                per_megapixel: estimate(time / 1e3, 0.0001),
                deviation: None,
            });
        }
        run
    }

    fn cost(costs: &[(f64, f64)]) -> Option<LayerCost> {
        let run = layered(costs);
        let methods = Methods::of(&run).unwrap();
        LayerCost::of(&methods.questions[0].scenes[0].series[0], 0)
    }

    #[test]
    fn the_cost_of_a_layer_is_the_slope_from_the_fewest_to_the_most() {
        let near = |a: f64, b: f64| (a - b).abs() < 1e-12;
        let line = cost(&[(2.0, 3.0), (4.0, 4.0), (12.0, 8.0)]).unwrap();
        assert!(near(line.seconds, 0.0005) && line.is_straight, "{line:?}");
        // 5 ms more for 10 layers, each end 0.1 ms off.
        let [low, high] = line.interval.unwrap();
        assert!(near(low, 0.00048) && near(high, 0.00052), "{line:?}");
        assert!(
            !cost(&[(2.0, 3.0), (4.0, 7.0), (12.0, 8.0)])
                .unwrap()
                .is_straight
        );
        assert_eq!(cost(&[(2.0, 3.0)]), None);
    }

    #[test]
    fn only_scenes_with_layers_have_the_table() {
        let text = |run: &Run| {
            let methods = Methods::of(run).unwrap();
            methods
                .shown()
                .iter()
                .find_map(section)
                .map(|table| table.into_string())
        };
        let shown = text(&layered(&[(2.0, 3.0), (12.0, 8.0)])).unwrap();
        assert!(
            shown.contains("from 2 to 12 layers") && shown.contains("500 µs"),
            "{shown}"
        );
        assert_eq!(
            text(&run(&[Made::new("transparency/hair/method=sorted")])),
            None
        );
    }
}
