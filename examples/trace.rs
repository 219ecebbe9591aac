use std::time::Duration;
use valet::body::*;
use valet::headless::*;
use valet::sim::world::*;
use valet::supervisor::*;
fn main() {
    let seed = std::env::args().nth(1).map_or(1, |s| s.parse().unwrap());
    let mut t =
        VirtualTrial::new(Setup { seed, ..Default::default() }, &WorldSetup { seed, ..Default::default() }).unwrap();
    let mut op = ScriptedOperator::new(3);
    let mut n = 0;
    let from: f64 = std::env::args().nth(2).map_or(17.5, |s| s.parse().unwrap());
    let r = t.run(&mut op, Duration::from_secs(300), |now, i, e| {
        for x in e {
            if let Effect::Log { text, .. } = x {
                println!("{:.2} {text}", now.seconds());
            }
        }
        if let Input::Endpoint(s) = i {
            if s.side == Side::Right && now.seconds() > from && now.seconds() < from + 4.0 {
                n += 1;
                if n % 5 == 0 {
                    println!(
                        "{:.2} p {:.3} {:.3} {:.3} F {:.2} {:.2} {:.2}",
                        now.seconds(),
                        s.pose.translation.x,
                        s.pose.translation.y,
                        s.pose.translation.z,
                        s.wrench.force.x,
                        s.wrench.force.y,
                        s.wrench.force.z
                    );
                }
            }
        }
    });
    println!("{r:?}");
}
