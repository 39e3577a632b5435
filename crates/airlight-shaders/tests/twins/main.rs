//! Every shader function, its Rust twin and f64 on the same random and singular inputs.
//!
//! The error that a function's documentation states bounds three differences: twin and f64, device and f64, device and twin.

mod device;
mod flat;
mod module;
mod random;
mod rows;
mod textures;
#[path = "../vulkan/mod.rs"]
mod vulkan;

use airlight::Named;
use airlight_shaders::{ErrorBound, Part, functions};
use device::{Device, Form};
use random::Random;
use rows::Row;

/// Inputs for each function.
const COUNT: usize = 4096;

/// A number that is subnormal in f32 may be flushed to 0.
const SMALLEST: f64 = 1e-36;

/// The largest ratio of a difference to its bound, with the inputs at which it occurs.
struct Worst {
    ratio: f64,
    difference: f64,
    at: String,
}

impl Worst {
    fn new() -> Self {
        Self {
            ratio: 0.0,
            difference: 0.0,
            at: String::new(),
        }
    }

    fn compare(&mut self, bound: ErrorBound, got: &[f64], right: &[f64], inputs: &[f32]) {
        assert_eq!(got.len(), right.len(), "numbers of a result");
        for (&got, &right) in got.iter().zip(right) {
            let difference = (got - right).abs();
            let ratio = difference / (bound.relative * right.abs() + bound.absolute + SMALLEST);
            if ratio.is_nan() || ratio > self.ratio {
                *self = Self {
                    ratio: if ratio.is_nan() { f64::INFINITY } else { ratio },
                    difference,
                    at: format!("got {got:e}, expected {right:e} at {inputs:?}"),
                };
            }
        }
    }
}

fn wide(numbers: &[f32]) -> Vec<f64> {
    numbers.iter().map(|&x| f64::from(x)).collect()
}

fn bound_of(name: &str) -> ErrorBound {
    let mut all = Part::ALL.iter().flat_map(|&part| functions(part));
    let function = all.find(|function| function.name == name);
    function.expect("a function of the library").error
}

/// Inputs of a row, the same in each test.
fn inputs_of(row: &Row) -> Vec<Vec<f32>> {
    let mut random = Random::new(row.name.bytes().map(u64::from).sum());
    (0..COUNT).map(|_| (row.inputs)(&mut random)).collect()
}

#[test]
fn every_function_has_a_row_and_a_twin() {
    let rows: Vec<&str> = rows::all().iter().map(|row| row.name).collect();
    let module = module::whole();
    for (_, function) in module.functions.iter() {
        let name = function.name.as_deref().expect("a name");
        let count = rows.iter().filter(|row| **row == name).count();
        assert_eq!(count, 1, "rows of {name}");
    }
    assert_eq!(rows.len(), module.functions.len());
    let documented = Part::ALL.iter().flat_map(|&part| functions(part)).count();
    assert_eq!(documented, module.functions.len());
}

#[test]
fn each_part_is_complete_with_what_it_requires() {
    for &part in Part::ALL {
        let text = airlight_shaders::source(&[part]);
        if let Err(e) = naga::front::wgsl::parse_str(&text) {
            panic!("{part}: {}", e.emit_to_string(&text));
        }
    }
}

#[test]
fn no_function_needs_a_binding_or_an_extension() {
    let module = module::whole();
    assert_eq!(module.global_variables.len(), 0);
    let flags = naga::valid::ValidationFlags::all();
    let none = naga::valid::Capabilities::empty();
    let valid = naga::valid::Validator::new(flags, none).validate(&module);
    assert!(valid.is_ok(), "{:?}", valid.err());
}

#[test]
fn stated_costs_are_those_of_the_code() {
    let costs = airlight_shaders::costs(&airlight_shaders::source(Part::ALL)).unwrap();
    let mut wrong = Vec::new();
    for function in Part::ALL.iter().flat_map(|&part| functions(part)) {
        let named = costs.iter().find(|(name, _)| name == function.name);
        let cost = named.expect("a function of the library").1.to_string();
        // What follows a semicolon is an explanation.
        let stated = function.cost.split("; ").next().expect("a first part");
        if stated != cost {
            wrong.push(format!("{}: {cost}, stated {stated}", function.name));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn twins_are_within_the_stated_errors() {
    let mut wrong = Vec::new();
    for row in rows::all() {
        let bound = bound_of(row.name);
        let mut worst = Worst::new();
        for inputs in inputs_of(&row) {
            let exact = (row.exact)(&wide(&inputs));
            worst.compare(bound, &wide(&(row.twin)(&inputs)), &exact, &inputs);
        }
        if worst.ratio > 1.0 {
            wrong.push(format!(
                "{}: {:.2} of the bound, {}",
                row.name, worst.ratio, worst.at
            ));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

/// Prints the differences of each function as fractions of its stated error.
#[test]
fn shaders_are_within_the_stated_errors() {
    compare(Form::Wgsl, COUNT);
}

/// Prints the same of the modules of SPIR-V, as read back and given to the driver.
#[test]
fn spirv_modules_are_within_the_stated_errors() {
    compare(Form::Spirv, COUNT / 16);
}

/// Compares device, twin and f64 on the first inputs of each function.
fn compare(form: Form, count: usize) {
    let device = Device::new(form);
    println!("{}", device.name);
    println!("largest difference / stated error: device and f64, twin and f64, device and twin");
    let mut wrong = Vec::new();
    for row in rows::all() {
        let bound = bound_of(row.name);
        let mut inputs = inputs_of(&row);
        inputs.truncate(count);
        let on_device = device.run(row.name, &inputs);
        let [mut exact, mut cpu, mut twin] = [Worst::new(), Worst::new(), Worst::new()];
        for (inputs, got) in inputs.iter().zip(&on_device) {
            let right = (row.exact)(&wide(inputs));
            let twin_got = wide(&(row.twin)(inputs));
            exact.compare(bound, &wide(got), &right, inputs);
            cpu.compare(bound, &twin_got, &right, inputs);
            twin.compare(bound, &wide(got), &twin_got, inputs);
        }
        println!(
            "{:28} {:5.2} {:5.2} {:5.2}   {:.1e}",
            row.name, exact.ratio, cpu.ratio, twin.ratio, twin.difference
        );
        for (what, worst) in [("f64", exact), ("the twin", twin)] {
            if worst.ratio > 1.0 {
                wrong.push(format!(
                    "{} against {what}: {:.2} of the bound, {}",
                    row.name, worst.ratio, worst.at
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}
