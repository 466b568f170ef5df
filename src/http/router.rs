//! Every route, in one table.

use std::net::IpAddr;
use std::sync::Arc;

use axum::Router;
use axum::body::Bytes;
use axum::extract::Request;
use axum::http::{HeaderValue, Uri, header};
use axum::middleware::{self, Next};
use axum::response::{IntoResponse as _, Response};
use axum::routing::get;
use tower_http::compression::CompressionLayer;
use utoipa::openapi::OpenApi;
use utoipa_axum::router::OpenApiRouter;
use utoipa_axum::routes;

use super::envelope::{self, Peer};
use super::problem::{self, ProblemAnswer};
use super::rate::Rates;
use super::scope::Scopes;
use super::settings::HttpSettings;
use super::state::{Caller, HttpService, State};
use super::tenant::{client, tenant};
use super::unpack::unpack;
use super::{
    about, contract, cors, deliveries, docs, events, framing, lifecycle, listing, operations, page,
    presigned, uploads,
};
use crate::jobs::Jobs;
use crate::wire::{Problem, ProblemCode};

/// The API, with its contract.
fn api() -> OpenApiRouter<Arc<HttpService>> {
    OpenApiRouter::new()
        .routes(routes!(operations::analyze))
        .routes(routes!(operations::repair))
        .routes(routes!(operations::convert))
        .routes(routes!(operations::verify))
        .routes(routes!(operations::simplify))
        .routes(routes!(operations::plan))
        .routes(routes!(operations::cut_stitch))
        .routes(routes!(operations::fill_holes))
        .routes(routes!(operations::modeller))
        .routes(routes!(operations::boolean))
        .routes(routes!(operations::render))
        .routes(routes!(operations::create_job, listing::list_jobs))
        .routes(routes!(lifecycle::show, lifecycle::delete))
        .routes(routes!(lifecycle::cancel))
        .routes(routes!(events::events))
        .routes(routes!(lifecycle::report))
        .routes(routes!(lifecycle::result))
        .routes(routes!(lifecycle::thumbnail))
        .routes(routes!(lifecycle::thumbnail_mesh))
        .routes(routes!(deliveries::deliveries))
        .routes(routes!(deliveries::redeliver))
        .routes(routes!(about::errors))
        .routes(routes!(about::limits))
        .routes(routes!(about::formats))
        .routes(routes!(about::policies))
        .routes(routes!(about::version))
        .merge(uploads())
        .merge(documents())
}

/// Uploads that come before their job.
fn uploads() -> OpenApiRouter<Arc<HttpService>> {
    OpenApiRouter::new()
        .routes(routes!(uploads::create, uploads::protocol))
        .routes(routes!(uploads::stand, uploads::append, uploads::delete))
        .layer(middleware::map_response(uploads::tell_version))
        .routes(routes!(presigned::create))
}

/// The contract itself, compressed for clients that take that: nothing in it is secret and repeated by a caller.
fn documents() -> OpenApiRouter<Arc<HttpService>> {
    OpenApiRouter::new()
        .routes(routes!(about::openapi))
        .routes(routes!(about::openapi_json))
        .layer(CompressionLayer::new())
}

/// Pages and what they load: embedded, from no other host, compressed as the contract is.
fn pages() -> Router<Arc<HttpService>> {
    let assets = page::ASSETS.iter().enumerate();
    assets
        .fold(Router::new(), |router, (at, asset)| router.route(asset.path, page::Asset::route(at)))
        .route("/docs", get(docs::show))
        .layer(CompressionLayer::new())
}

/// The contract.
pub(super) fn openapi() -> OpenApi {
    contract::complete(api().into_openapi())
}

/// What handlers share, with the contract made once.
pub(super) fn service(settings: HttpSettings, jobs: Jobs) -> Arc<HttpService> {
    let document = openapi();
    let json = serde_json::to_vec(&document).unwrap_or_default();
    Arc::new(HttpService {
        jobs,
        rates: settings.rate.map(Rates::new),
        settings,
        docs: Bytes::from(docs::render(&document)),
        openapi: Bytes::from(contract::yaml(&document)),
        openapi_json: Bytes::from(json),
    })
}

/// The router of the public listener.
pub(super) fn router(service: Arc<HttpService>) -> Router {
    let (api, _) = api().layer(middleware::map_request(unpack)).split_for_parts();
    let let_in = middleware::from_fn_with_state(Arc::clone(&service), let_in);
    let cors = cors::layer(&service.settings.cors_origins);
    let routes = complete(api.merge(pages()).with_state(service)).layer(let_in);
    // Outside of the door: browsers ask with no key whether they may ask.
    enveloped(match cors {
        Some(cors) => routes.layer(cors),
        None => routes,
    })
}

/// `routes` with problems for the paths and methods that they do not know.
pub(super) fn complete(routes: Router) -> Router {
    routes.fallback(not_found).method_not_allowed_fallback(method_not_allowed)
}

/// `routes` with what every answer has in common.
pub(super) fn enveloped(routes: Router) -> Router {
    routes.layer(middleware::from_fn(envelope::envelop))
}

/// Lets in who may use the service, as often as that is allowed. With keys, the pages are for everybody: they ask for
/// the key.
async fn let_in(service: State, mut request: Request, next: Next) -> Response {
    let peer = request.extensions().get::<Peer>().map(|peer| peer.0);
    if let Err(problem) = framing::check(&mut request) {
        return problem::respond(problem);
    }
    let address = client(request.headers(), peer, &service.settings.trusted_proxies);
    let is_page = !request.uri().path().starts_with("/v1/");
    let is_open = service.settings.access.has_keys() && is_page;
    let holder = if is_open { Ok(None) } else { service.settings.access.check(request.headers(), peer) };
    let (owner, scopes) = match holder {
        Ok(Some(holder)) => (Some(holder.owner), holder.scopes),
        Ok(None) => (None, Scopes::ALL),
        Err(problem) => return not_let_in(&service, problem, address),
    };
    let caller = Caller { tenant: tenant(owner.as_deref(), address), owner };
    let counted = service.rates.as_ref().filter(|_| !is_page).map(|rates| rates.count(&caller.tenant));
    let refusal = match &counted {
        Some((_, Some(refusal))) => Some(refusal.clone()),
        _ => scopes.check(request.method(), request.uri().path()).err(),
    };
    request.extensions_mut().insert(caller.clone());
    let mut response = match refusal {
        Some(refusal) => problem::respond(refusal),
        None => next.run(request).await,
    };
    if let Some((standing, _)) = counted {
        standing.tell(response.headers_mut());
    }
    response.extensions_mut().insert(caller);
    response
}

/// The answer to one who has no valid key or comes from a foreign host. They are counted by their address, and their
/// connection ends: it takes the place of one who may use the service.
fn not_let_in(service: &HttpService, problem: Problem, address: Option<IpAddr>) -> Response {
    let counted = service.rates.as_ref().map(|rates| rates.count(&tenant(None, address)));
    let (standing, refusal) = counted.unzip();
    let mut response = problem::respond(refusal.flatten().unwrap_or(problem));
    response.headers_mut().insert(header::CONNECTION, HeaderValue::from_static("close"));
    if let Some(standing) = standing {
        standing.tell(response.headers_mut());
    }
    response
}

async fn not_found(uri: Uri) -> Response {
    match uri.path().strip_suffix('/').filter(|path| path.starts_with('/')) {
        None => ProblemAnswer::new(ProblemCode::NotFound, "there is nothing at this path").into_response(),
        Some(path) => problem::respond(Problem {
            suggestion: Some(path.to_owned().into()),
            ..Problem::new(
                ProblemCode::NotFound,
                "there is nothing at this path; no path of this service ends with a slash",
            )
        }),
    }
}

async fn method_not_allowed() -> Response {
    ProblemAnswer::new(ProblemCode::MethodNotAllowed, "`Allow` lists the methods of this path")
        .into_response()
}
