// Answers the questions of ask.txt by sea_waves.rs: see tests/clients/sea_waves.py.
mod sea_waves;
use sea_waves::{SeaWaves, Water};

fn main() {
    let mut sea: Option<SeaWaves> = None;
    for line in std::fs::read_to_string("ask.txt").unwrap().lines() {
        let words: Vec<&str> = line.split(' ').collect();
        if words[0] == "sea" {
            match SeaWaves::open(words[1], words[2].parse().unwrap_or(usize::MAX)) {
                Ok(one) => {
                    println!("ok {:?}", one.neglected_rms);
                    sea = Some(one);
                }
                Err(rule) => println!("error {rule}"),
            }
            continue;
        }
        let p: Vec<f64> = words[1..].iter().map(|word| word.parse().unwrap()).collect();
        let one = sea.as_ref().unwrap();
        let Water { x0, y0, x, y, height, normal: n, residual, jacobian, .. } =
            if words[0] == "at" { one.at(p[0], p[1], p[2]) } else { one.rest(p[0], p[1], p[2]) };
        let all = [x0, y0, x, y, height, n[0], n[1], n[2], residual, jacobian];
        println!("{}", all.map(|value| format!("{value:?}")).join(" "));
    }
}
