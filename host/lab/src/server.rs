//! The server: one port of the loopback interface, one token, the sessions of one folder.

use super::guard::{AccessToken, guard};
use super::live::{LiveRobot, RobotAccess};
use super::routes;
use super::session::{ProjectFiles, SessionStore};
use crate::error::{Error, Result};
use axum::Router;
use axum::middleware::from_fn_with_state;
use std::net::{Ipv4Addr, SocketAddr, TcpListener};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Longest that a robot may take to be let down softly before torque is switched off at once.
const LET_DOWN: Duration = Duration::from_secs(3);

/// What a lab is opened with.
#[derive(Debug, Clone)]
pub struct LabOptions {
    /// Model and logs that a new session starts with.
    pub given: ProjectFiles,
    /// Where sessions are kept.
    pub folder: PathBuf,
    /// Port of the loopback interface; 0 takes a free one.
    pub port: u16,
    /// The robot that pages may watch, if there is one.
    pub robot: Option<RobotAccess>,
}

/// What every request sees.
#[derive(Debug)]
pub(super) struct LabState {
    pub token: AccessToken,
    pub port: u16,
    pub store: SessionStore,
    pub robot: Option<Arc<LiveRobot>>,
}

impl LabState {
    /// Name of the cookie with the token. Cookies know no ports: two labs on one machine need two
    /// names.
    pub fn cookie_name(&self) -> String {
        format!("handstand_lab_{}", self.port)
    }

    /// Whether a request is addressed to this server.
    pub fn is_own_host(&self, host: &str) -> bool {
        let port = self.port;
        host == format!("127.0.0.1:{port}") || host == format!("localhost:{port}")
    }

    /// Whether a page of this server asks.
    pub fn is_own_origin(&self, origin: &str) -> bool {
        let host = origin.strip_prefix("http://");
        host.is_some_and(|host| self.is_own_host(host))
    }
}

/// A lab that listens.
#[derive(Debug)]
pub struct Lab {
    listener: TcpListener,
    state: Arc<LabState>,
}

impl Lab {
    /// Takes the port and opens the folder of sessions.
    ///
    /// # Errors
    /// A port that is taken, a folder that cannot be made or read, a model or log that cannot be
    /// read.
    pub fn bind(options: LabOptions) -> Result<Lab> {
        let address = SocketAddr::from((Ipv4Addr::LOCALHOST, options.port));
        let refused = |why: std::io::Error| {
            let port = options.port;
            Error::device(
                format!("cannot listen on port {port} of this machine: {why}"),
                "choose another --port, or leave it out",
            )
        };
        let listener = TcpListener::bind(address).map_err(refused)?;
        let port = listener.local_addr().map_err(refused)?.port();
        listener.set_nonblocking(true).map_err(refused)?;
        let state = LabState {
            token: AccessToken::random(),
            port,
            store: SessionStore::open(options.folder, options.given)?,
            robot: options.robot.map(|robot| Arc::new(LiveRobot::new(robot))),
        };
        Ok(Lab {
            listener,
            state: Arc::new(state),
        })
    }

    /// The address to open in a browser of this machine; whoever knows it may use the lab.
    pub fn address(&self) -> String {
        let LabState { token, port, .. } = &*self.state;
        format!("http://127.0.0.1:{port}/enter?token={}", token.text())
    }

    /// The folder of its sessions.
    pub fn folder(&self) -> &std::path::Path {
        self.state.store.folder()
    }

    /// Serves until Ctrl-C or the system's wish that it ends; then lets the robot down.
    ///
    /// # Errors
    /// The system's refusal.
    pub fn serve(self) -> Result<()> {
        let failed = |why: std::io::Error| {
            Error::device(format!("the lab's server stopped: {why}"), "start it again")
        };
        let runtime = tokio::runtime::Builder::new_multi_thread()
            .enable_all()
            .build()
            .map_err(failed)?;
        let (state, robot) = (self.state.clone(), self.state.robot.clone());
        let served = runtime.block_on(async {
            let listener = tokio::net::TcpListener::from_std(self.listener)?;
            let app = router(state);
            tokio::select! {
                served = async { axum::serve(listener, app).await } => served,
                pressed = tokio::signal::ctrl_c() => pressed,
                () = told_to_end() => Ok(()),
            }
        });
        if let Some(robot) = robot {
            robot.stop_for_good(LET_DOWN);
        }
        // A fit may run on; what was saved is whole already.
        runtime.shutdown_background();
        served.map_err(failed)
    }
}

/// Waits until the system tells the program to end.
#[cfg(unix)]
async fn told_to_end() {
    use tokio::signal::unix::{SignalKind, signal};
    match signal(SignalKind::terminate()) {
        Ok(mut told) => {
            told.recv().await;
        }
        // Then the system ends it at once, and the CM-5 lets the robot down by itself.
        Err(_) => std::future::pending().await,
    }
}

/// Waits for ever: Ctrl-C is all there is.
#[cfg(not(unix))]
async fn told_to_end() {
    std::future::pending().await
}

fn router(state: Arc<LabState>) -> Router {
    routes::all()
        .layer(from_fn_with_state(state.clone(), guard))
        .with_state(state)
}
