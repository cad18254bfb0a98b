//! The clock of the processors, if the system reports it.

use std::fs;

/// Returns the mean clock of all processors in MHz; `None` if `/proc/cpuinfo` does not report it.
pub(crate) fn measure() -> Option<f64> {
    mean(&fs::read_to_string("/proc/cpuinfo").ok()?)
}

fn mean(text: &str) -> Option<f64> {
    let value = |line: &str| -> Option<f64> {
        let (key, value) = line.split_once(':')?;
        let value: f64 = value.trim().parse().ok()?;
        (key.trim() == "cpu MHz" && value > 0.0 && value.is_finite()).then_some(value)
    };
    let values: Vec<f64> = text.lines().filter_map(value).collect();
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clock_rates_are_averaged_if_the_system_lists_them() {
        let text = "processor\t: 0\ncpu MHz\t\t: 2000.000\n\nprocessor\t: 1\ncpu MHz\t\t: 3000.5\n";
        assert_eq!(mean(text), Some(2500.25));
        assert_eq!(mean("processor : 0\nBogoMIPS : 50.00\n"), None);
        assert_eq!(mean("cpu MHz : nan\ncpu MHz : 0\n"), None);
    }
}
