//! The comparison of a claim in words, from the claim's data.

use crate::methods::name::title;
use crate::numbers::digits;
use etalon_methods::{Claim, ClaimedValues, FigureCondition, Test};

/// Returns the comparison, its cases and its condition.
pub(super) fn compared(claim: &Claim) -> String {
    let mut text = match claim.test {
        Test::Value {
            quantity,
            of,
            holds,
        } => {
            let name = title(quantity.name());
            format!(
                "{name} of {of}. Holds {}",
                condition(holds, share_of(quantity))
            )
        }
        Test::Ratio {
            quantity,
            of,
            over,
            holds,
        } => format!(
            "{} of {} over that of {}. Holds {}",
            title(quantity.name()),
            sum(of),
            sum(over),
            condition(holds, false)
        ),
        Test::Same { methods: [a, b] } => {
            format!("RMSE and largest error of {a} and {b}. Holds if both are the same")
        }
        Test::Trend {
            quantity,
            of,
            holds,
        } => format!(
            "{} of {of} at the largest value of the parameter over that at the smallest. Holds {}",
            title(quantity.name()),
            condition(holds, false)
        ),
        Test::Unlike { right, wrong } => format!(
            "RMSE of {right} and of {wrong} at every value of the parameter. Holds if the first is within 1 % at all of them, and the second is not"
        ),
        Test::Halves { of, over } => format!(
            "Passes and RMSE of {of} at each value of the parameter, over those of {over} at twice the value. \
             Holds if the error is at most 1.5 times as large in at most half the passes and two more"
        ),
        Test::Narrowest { of, over, holds } => format!(
            "The smallest value of the parameter from which on {of} stays within 1 % RMSE, over that of {over}. Holds {}",
            condition(holds, false)
        ),
        Test::Levels { of, samples } => format!(
            "RMSE of {of} along the parameter. Holds if each {samples}th of 1 is within 0.5 %, and every value halfway between two of them at \
             least four times as far off"
        ),
        Test::HalfCodes { of, holds } => format!(
            "Largest error of {of} times the parameter, in halves of a code. Holds {}",
            condition(holds, false)
        ),
    };
    let families = match claim.families {
        [] => claim.question.to_owned(),
        some => {
            let names: Vec<String> = some
                .iter()
                .map(|f| format!("{}/{f}", claim.question))
                .collect();
            names.join(", ")
        }
    };
    text += &format!(". Cases: {families}");
    match claim.values {
        ClaimedValues::All => {}
        ClaimedValues::Between(low, high) if high.is_infinite() => {
            text += &format!(" from {} on", digits(low, 3));
        }
        ClaimedValues::Between(low, high) => {
            text += &format!(" from {} to {}", digits(low, 3), digits(high, 3));
        }
    }
    if let Some([less, more]) = claim.fewer {
        text += &format!(", on adapters where {less} counts fewer fragments than {more}");
    }
    text.push('.');
    if !claim.note.is_empty() {
        text.push(' ');
        text.push_str(claim.note);
    }
    text
}

fn share_of(quantity: etalon_methods::Quantity) -> bool {
    use etalon_methods::Quantity;
    matches!(quantity, Quantity::Rmse | Quantity::Largest)
}

fn condition(condition: FigureCondition, share: bool) -> String {
    let text = |v: f64| {
        if share {
            crate::numbers::share(v)
        } else {
            digits(v, 3)
        }
    };
    match condition {
        FigureCondition::Below(limit) => format!("below {}", text(limit)),
        FigureCondition::Above(limit) => format!("above {}", text(limit)),
        FigureCondition::AtMost(limit) => format!("up to {}", text(limit)),
        FigureCondition::Between(low, high) if low == high => format!("at {}", text(low)),
        FigureCondition::Between(low, high) => format!("from {} to {}", text(low), text(high)),
    }
}

/// Returns the difference of two methods' quantities, such as `depth-prepass less that of unsorted`.
fn sum(terms: &[(&str, f64)]) -> String {
    let mut text = String::new();
    for (i, (method, sign)) in terms.iter().enumerate() {
        if i > 0 {
            text.push_str(if *sign < 0.0 {
                " less that of "
            } else {
                " and that of "
            });
        }
        text.push_str(method);
    }
    text
}
