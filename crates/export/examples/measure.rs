//! temporary
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let h = etalon_history::History::open_read(a[1].as_ref()).unwrap();
    let f = match &*a[3] {
        "parquet" => etalon_export::Format::Parquet,
        "otava" => etalon_export::Format::Otava,
        _ => etalon_export::Format::OpenMetrics,
    };
    let s = etalon_export::Selection {
        since: None,
        last: Some(a[4].parse().unwrap()),
    };
    let t = std::time::Instant::now();
    println!(
        "{:?} in {:?}",
        etalon_export::export(&h, f, &s, a[2].as_ref()).unwrap(),
        t.elapsed()
    );
}
