//! `etalon preflight`: which known bugs a driver shows, and what it draws right.
#![expect(clippy::unwrap_used, reason = "a test that panics has failed")]

use crate::etalon::etalon;
use predicates::prelude::*;
use predicates::str::contains;
use serde_json::{Value, json};

fn asked(adapter: &str) -> Value {
    let assert = etalon(&["preflight", "--json", "--adapter", adapter]).assert();
    let output = assert.code(0).get_output().stdout.clone();
    serde_json::from_slice(&output).unwrap()
}

/// Returns the names of the facts that are as safe as this.
fn of<'v>(facts: &'v Value, safety: &str) -> Vec<&'v str> {
    let facts = facts.as_object().unwrap().iter();
    let named = facts.filter(|(_, fact)| fact["safety"] == safety);
    named.map(|(name, _)| name.as_str()).collect()
}

fn bug<'v>(answer: &'v Value, finding: &str) -> &'v Value {
    let bugs = answer["bugs"].as_array().unwrap();
    bugs.iter()
        .find(|b| b["finding"] == finding)
        .unwrap_or_else(|| {
            panic!("{finding} is not among {bugs:#?}");
        })
}

#[test]
fn the_rasterizer_draws_everything_right() {
    let answer = asked("cpu");
    assert_eq!(answer["bugs"], json!([]));
    for facts in [&answer["formats"], &answer["states"]] {
        for safety in ["partly", "wrong", "unclear"] {
            assert_eq!(of(facts, safety), [""; 0], "{safety}");
        }
    }
    let safe = of(&answer["states"], "safe");
    assert!(safe.contains(&"samples=4") && safe.contains(&"logic-operation"));
    assert!(answer["drawn"].as_u64().unwrap() > 1000);
}

#[test]
fn the_bugs_of_a_driver_are_seen_and_only_what_they_need_is_unsafe() {
    let answer = asked("vulkan:lavapipe");
    let logic = bug(&answer, "llvmpipe-logic-four-bits");
    assert_eq!(logic["advice"]["tolerance"]["codes"], 1);
    let scissor = bug(&answer, "llvmpipe-scissor-samples");
    assert_eq!(
        (&scissor["advice"], &scissor["verdict"]),
        (&"skip".into(), &"fail".into())
    );
    let partly = of(&answer["states"], "partly");
    let safe = of(&answer["states"], "safe");
    for state in ["scissor", "samples=4", "logic-operation"] {
        assert!(partly.contains(&state), "{state}: {partly:?}");
    }
    for state in ["depth-test", "cull", "dual-source", "color=unorm8"] {
        assert!(safe.contains(&state), "{state}: {safe:?}");
    }
    assert!(of(&answer["formats"], "safe").contains(&"rgba8unorm"));
    // What the driver lacks is no fault.
    assert!(of(&answer["states"], "not_supported").contains(&"samples=16"));
}

#[test]
fn a_fault_that_no_finding_knows_is_reduced_to_what_it_needs() {
    let answer = asked("gl:llvmpipe:call-fault=cull-kept");
    let bugs = answer["bugs"].as_array().unwrap();
    let of_cull = bugs
        .iter()
        .find(|bug| bug["needs"] == json!(["cull"]))
        .unwrap();
    assert_eq!(of_cull["finding"], Value::Null);
    let bugs = answer["states"]["cull"]["bugs"].as_array().unwrap();
    assert!(bugs.contains(&of_cull["example"]), "{bugs:?}");
}

#[test]
fn the_text_names_what_to_do() {
    etalon(&["preflight", "--adapter", "gl:softpipe"])
        .assert()
        .code(0)
        .stdout(
            contains("gl:softpipe (")
                .and(contains("skip: softpipe treats points as back-facing"))
                .and(contains("needs topology=point-list"))
                .and(contains("Why: etalon explain "))
                .and(contains("  safe  "))
                .and(contains("not supported  ")),
        );
    etalon(&["preflight", "--adapter", "softpipe"])
        .assert()
        .code(64)
        .stderr(contains("gl:softpipe"));
}

#[test]
fn a_driver_that_does_not_start_is_given_up_before_the_time_is_over() {
    etalon(&["preflight", "--adapter", "cpu:fault=mute"])
        .assert()
        .code(3)
        .stderr(contains("no answer within 15 s"));
}

#[test]
fn what_a_reduced_case_needs_fits_other_cases_of_its_bug() {
    let answer = asked("vulkan:lavapipe");
    let needs = &bug(&answer, "lavapipe-input-depth")["needs"];
    let needs: Vec<&str> = needs
        .as_array()
        .unwrap()
        .iter()
        .map(|n| n.as_str().unwrap())
        .collect();
    assert!(!needs.contains(&"sample-shading"), "{needs:?}");
    assert!(needs.contains(&"texture"), "{needs:?}");
    // No case with this format was drawn and wrong, but the finding has one.
    assert!(of(&answer["formats"], "partly").contains(&"depth16unorm"));
    assert!(of(&answer["sampled"], "safe").contains(&"rgba8unorm"));
}

#[test]
fn an_answer_about_some_states_has_only_the_bugs_that_they_can_meet() {
    let mut command = etalon(&["preflight", "--json", "--adapter", "vulkan:lavapipe"]);
    command.args(["--uses", "scissor,samples=4,rgba8unorm"]);
    let output = command.assert().code(0).get_output().stdout.clone();
    let answer: Value = serde_json::from_slice(&output).unwrap();
    bug(&answer, "llvmpipe-scissor-samples");
    for bug in answer["bugs"].as_array().unwrap() {
        let needs = bug["needs"].as_array().unwrap();
        let stray = needs.iter().find(|need| {
            !["scissor", "samples"]
                .iter()
                .any(|met| need.as_str().unwrap().starts_with(met))
        });
        assert_eq!(stray, None, "{bug}");
    }
    assert_eq!(of(&answer["states"], "partly"), ["samples=4", "scissor"]);
    assert_eq!(of(&answer["formats"], "safe"), ["rgba8unorm"]);
    etalon(&["preflight", "--adapter", "cpu", "--uses", "scisor"])
        .assert()
        .code(64)
        .stderr(contains("did you mean `scissor`?"));
}
